// The plan as text and as JSON: the motions and where they end, the files, and those that are kept.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/format/keys.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/sweep/sweep_grid.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

struct Line {
    std::string what, name, content;
};

Line line_of(const Plan& plan, const PlannedMotion& motion) {
    const sim::Beam& beam = motion.problem.beam;
    const bool rigid = beam.model == sim::ModelKind::rigid;
    const double end = motion.ends_at_event ? std::max(motion.request.end_time, plan.events_until.value_or(0))
                                            : motion.request.end_time;
    return {"motion", rigid ? name(beam.model) : fmt::format("{}, {}", name(beam.model), counted(beam.modes, "mode")),
            fmt::format("until {:g} s{}{}{}", end, motion.ends_at_event ? " at most" : "",
                        motion.label.empty() ? "" : fmt::format(", \"{}\"", motion.label),
                        motion.horizon ? ", compared with further runs" : "")};
}

std::vector<Line> lines_of(const Plan& plan, const Scene& scene) {
    std::vector<Line> lines;
    const auto add_files = [&](std::string what, const std::string& file, std::string content, std::size_t output) {
        lines.push_back({std::move(what), file, std::move(content)});
        const std::vector<std::string> all = written_by(scene.outputs[output]);
        for (std::size_t i = 1; i < all.size(); ++i) lines.push_back({"", all[i], {}});
    };
    if (plan.simulation) lines.push_back(line_of(plan, *plan.simulation));
    for (const PlannedMotion& other : plan.others) lines.push_back(line_of(plan, other));
    if (!plan.sweep.empty()) {
        std::vector<std::string> keys;
        for (const SweptKey& over : scene.sweep->over) keys.push_back(over.key);
        lines.push_back(
            {"sweep", fmt::format("{}", fmt::join(keys, " and ")), counted(SweepGrid(scene).points(), "point")});
    }
    for (const Pictures& p : plan.pictures) {
        const PictureType& type = *std::ranges::find(kPictureTypes, p.kind, &PictureType::kind);
        const bool counts = p.has_frames() && !p.draw.empty();
        add_files(type.name, p.file, counts ? counted(p.draw.size(), "frame") : "", p.output);
    }
    for (const FigureFile& f : plan.figures) add_files("figure", f.file, f.figure, f.output);
    for (const DataFile& d : plan.data) add_files(d.type, d.file, d.content, d.output);
    for (const std::string& file : plan.kept) lines.push_back({"kept", file, {}});
    return lines;
}

}  // namespace

std::string to_text(const Plan& plan, const Scene& scene) {
    std::string text;
    for (const Line& line : lines_of(plan, scene))
        text += fmt::format("{:<11} {}{}{}\n", line.what, line.name, line.content.empty() ? "" : ": ", line.content);
    return text;
}

std::string to_json(const Plan& plan, const Scene& scene) {
    return to_text(array_node(lines_of(plan, scene), [](const Line& line) {
        return object_node({{"what", line.what}, {"name", line.name}, {"content", line.content}});
    }));
}

}  // namespace beamcam::scenes
