// The profile of a cam: JSON of its keys, or a CSV table whose first two columns are points. Each is refused with a
// message or is a convex outline that a lever follows.
#include "output/data/table_reader.hpp"
#include "scenes/format/reader.hpp"
#include "sim/cam/lever.hpp"
#include "sim/dynamics/validate.hpp"
#include "tests/fuzz/support.hpp"

namespace {

using namespace beamcam;

std::optional<sim::Problem> problem_of_keys(std::string_view text) {
    const scenes::Reading reading =
        scenes::read_scene({"fuzz.json", R"({"cam": {"profile": )" + std::string(text) + "}}", true});
    fuzz::claim(reading.scene.has_value() || !reading.report().empty(), "a scene, or a reason why it is none");
    if (!reading.scene) return std::nullopt;
    return reading.scene->problem;
}

std::optional<sim::Problem> problem_of_points(std::string_view text) {
    try {
        const output::ColumnTable table = output::parse_csv(text, "fuzz.csv");
        if (table.columns.size() < 2) return std::nullopt;
        sim::Problem problem;
        problem.cam->profile = sim::PointsProfile{table.columns[0].values, table.columns[1].values};
        for (const sim::Issue& issue : sim::validate(problem)) {
            fuzz::claim(!issue.message.empty(), "a message says something");
            if (issue.fatal) return std::nullopt;
        }
        return problem;
    } catch (const output::IoError& error) {
        fuzz::claim(error.what()[0] != 0, "a refusal says why");
        return std::nullopt;
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    const auto problem = text.starts_with('{') ? problem_of_keys(text) : problem_of_points(text);
    if (!problem || !problem->cam || !problem->cam->profile) return 0;
    const sim::Lever lever(*problem);
    fuzz::claim(lever.shape().least_radius() > 0 && lever.shape().least_height() > 0, "the outline is convex");
    fuzz::claim(!(lever.at(1).foot < 0), "the lever touches it on the way from the pivot");
    (void)lever.summary();
    return 0;
}
