// The apex of the first rebound against the number of modes.
#include <fmt/ranges.h>

#include <array>

#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"

namespace beamcam::scenes {
namespace {

using sim::Basis;

constexpr std::size_t kSearchedCollisions = 20;  // for a rebound
constexpr std::array kModes{1, 2, 3, 4, 5, 6, 8};

constexpr std::array kShapes{Basis::hub_beam, Basis::cantilever};

struct ApexRun {
    std::size_t shapes;  // of kShapes
    int modes;
    sim::Problem problem;
    std::size_t study = 0;
};

std::vector<ApexRun> apex_runs(const sim::Problem& problem) {
    std::vector<ApexRun> runs;
    for (std::size_t k = 0; k < kShapes.size(); ++k)
        for (const int modes : kModes) {
            // Cantilever shapes with many modes lose the inertia of a light hub; see the model's limits.
            if (kShapes[k] == Basis::cantilever && modes > 6) continue;
            runs.push_back({k, modes, problem});
            set_shapes(runs.back().problem, sim::ModelKind::first_order, kShapes[k], modes);
        }
    return runs;
}

// Which numbers of shapes have no point.
std::string missing_points(const std::array<std::vector<int>, 2>& missing, Lang lang) {
    std::vector<std::string> lists;
    for (std::size_t k = 0; k < missing.size(); ++k)
        if (!missing[k].empty())
            lists.push_back(phrase(lang, "{} shapes with $N$ = {}", "{}模态 $N$ = {}", shapes_name(kShapes[k], lang),
                                   fmt::join(missing[k], ", ")));
    if (lists.empty()) return {};
    return phrase(lang, "No point for {}: there the motion has no rebound, or its integration stops before it. ",
                  "{} 无数据点：该运动无回弹，或积分在此之前终止。", fmt::join(lists, phrase(lang, "; ", "；")));
}

FigureDrawing prepare_apex(const Scene& scene, const FigureOutput&, Studies& studies) {
    std::vector<ApexRun> runs = apex_runs(scene.problem);
    for (ApexRun& run : runs) {
        run.study = studies.of(run.problem, scene.end_time);
        studies.apexes(run.study);
        studies.may_fail(run.study);
        studies.stop_after(run.study, {.collisions = kSearchedCollisions});
    }
    return [runs](const Subject& subject, const Results& results) -> Figure {
        const Lang lang = subject.lang;
        const Measure angle = measure_in(subject.units, "rad");
        std::vector<Series> series;
        for (const Basis basis : kShapes)
            series.push_back({.label = phrase(lang, "{} shapes", "{}模态", shapes_name(basis, lang)),
                              .look = static_cast<int>(series.size()),
                              .every_point = true});
        std::array<std::vector<int>, 2> missing;  // numbers of shapes without an apex
        Runs used;
        for (const ApexRun& run : runs) {
            if (const std::optional<double> apex = rebound_apex(run.problem, *results[run.study], subject.end_time)) {
                series[run.shapes].add(run.modes, angle.factor * *apex);
                used.emplace_back(&run.problem, results[run.study]);
            } else {
                missing[run.shapes].push_back(run.modes);
            }
        }
        if (used.empty())
            throw render::PictureError(
                "figure apex-modes: θ does not rise above its value at the first touch before the scene ends, or the "
                "beam strikes the cam from below; raise time.end or set initial.angle");
        return {.panels = {{.x = {.label = "$N$", .counts = true},
                            .y = {.label = axis_label("$θ_{\\r{apex}}$", angle.unit)},
                            .series = std::move(series),
                            .legend = Legend::box}},
                .aspect = 0.62,
                .caption = phrase(lang,
                                  "Highest hub angle of the first rebound against the number $N$ of shape functions, "
                                  "model first-order. ",
                                  "首次回弹的最大转角随形函数个数 $N$ 的变化，一阶模型。") +
                           missing_points(missing, lang) + facts(subject, {.model = true, .modes = true}),
                .accuracy = accuracy(used, lang)};
    };
}

std::optional<std::string> needs_free_cam(const Scene& scene) {
    if (auto no_cam = needs_cam(scene)) return no_cam;
    return needs_free_hub(scene);
}

}  // namespace

extern const FigureType kApexModes{"apex-modes",
                                   {"Rebound apex against the number of modes", "回弹最高点随模态数的变化"},
                                   needs_free_cam,
                                   prepare_apex};

}  // namespace beamcam::scenes
