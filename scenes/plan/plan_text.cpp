// The plan as text and as JSON: the motions and where they end, the files, and those that are kept.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "output/json/tree.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/sweep/sweep_grid.hpp"
#include "sim/base/counted.hpp"
#include "sim/observe/recorder.hpp"

namespace beamcam::scenes {
namespace {

struct Line {
    std::string what, name, content;
};

// One line for all requests of a motion.
void add_motions(const Plan& plan, std::vector<Line>& lines) {
    std::vector<MotionRequest> all;
    for (const MotionRequest& each : plan.motions) {
        const auto same = std::ranges::find(all, each.key, &MotionRequest::key);
        if (same == all.end()) {
            all.push_back(each);
            all.back().request.end_time = end_of(each.request);
            continue;
        }
        same->request.end_time = std::max(same->request.end_time, end_of(each.request));
        same->request.horizon = same->request.horizon || each.request.horizon;
        if (same->label.empty()) same->label = each.label;
    }
    for (const MotionRequest& each : all) {
        const sim::Beam& beam = each.problem.beam;
        const bool rigid = beam.model == sim::ModelKind::rigid;
        lines.push_back(
            {"motion", rigid ? name(beam.model) : fmt::format("{}, {}", name(beam.model), counted(beam.modes, "mode")),
             fmt::format("until {:g} s{}{}", each.request.end_time,
                         each.label.empty() ? "" : fmt::format(", \"{}\"", each.label),
                         each.request.horizon ? ", compared with a second run" : "")});
    }
}

std::string type_of(const Output& output) {
    if (const auto* picture = std::get_if<PictureOutput>(&output))
        return std::ranges::find(kPictureTypes, picture->kind, &PictureType::kind)->name;
    return std::visit(
        [](const auto& each) -> std::string {
            if constexpr (requires { each.kType; }) return each.kType;
            return {};
        },
        output);
}

std::vector<Line> lines_of(const Plan& plan, const Scene& scene) {
    std::vector<Line> lines;
    add_motions(plan, lines);
    if (!plan.sweep.empty()) {
        std::vector<std::string> keys;
        for (const SweptKey& over : scene.sweep->over) keys.push_back(over.key);
        lines.push_back(
            {"sweep", fmt::format("{}", fmt::join(keys, " and ")), counted(SweepGrid(scene).points(), "point")});
    }
    const auto add_output = [&](std::size_t output, std::string content) {
        const std::vector<std::string> files = written_by(scene.outputs[output]);
        lines.push_back({type_of(scene.outputs[output]), files.front(), std::move(content)});
        for (std::size_t i = 1; i < files.size(); ++i) lines.push_back({"", files[i], {}});
    };
    for (const PlannedPictures& p : plan.pictures)
        add_output(p.output, p.has_frames() ? counted(p.draw.size(), "frame") : "");
    for (const FigureFile& f : plan.figures) add_output(f.output, f.figure);
    for (const DataFile& d : plan.data) lines.push_back({type_of(scene.outputs[d.output]), d.file, d.content});
    for (const std::size_t output : plan.waiting)
        add_output(output, fmt::format("at events, found by a run until {:g} s at most",
                                       events_until(scene.outputs[output], scene)));
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
    constexpr std::size_t kWidth = 120;
    const Node lines = array_node(lines_of(plan, scene), [](const Line& line) {
        return object_node({{"what", line.what}, {"name", line.name}, {"content", line.content}});
    });
    return folded_text(lines, kWidth, 0) + "\n";
}

}  // namespace beamcam::scenes
