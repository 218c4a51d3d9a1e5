// Output "impacts": all impacts and collisions, as JSON or CSV.
#include "output/data/records.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/outputs/run_context.hpp"
#include "scenes/plan/planner.hpp"

namespace beamcam::scenes {

void ImpactsOutput::visit(SceneVisitor& v) { visit_file(v, file, {".json", ".csv"}, "-impacts.json"); }

void ImpactsOutput::plan(Planner& planner, std::size_t output) const {
    const auto write = [](const DataSource& from) {
        if (from.file)
            output::write_impacts(*from.file, from.run);
        else
            output::print_json(output::impacts_json(from.run));
        return fmt::format("{} in {}", counted(from.run.impacts.size(), "impact"),
                           counted(from.run.collisions.size(), "collision"));
    };
    planner.simulate_until(planner.run_end(), file);
    planner.add(DataFile{output, file, "impacts", write});
}

}  // namespace beamcam::scenes
