// How much the number of modes matters: the apex of the first rebound against it.
#include <array>

#include "scenes/figures/recipes.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::Figure;
using render::figure::Legend;
using render::figure::Panel;
using render::figure::Series;
using sim::Basis;

constexpr std::array kModes{1, 2, 3, 4, 5, 6, 8};

struct ApexRun {
    Basis basis;
    int modes;
    sim::Problem problem;
    std::size_t study = 0;
};

std::vector<ApexRun> apex_runs(const sim::Problem& problem) {
    std::vector<ApexRun> runs;
    for (const Basis basis : {Basis::hub_beam, Basis::cantilever})
        for (const int modes : kModes) {
            // Cantilever shapes with many modes lose the inertia of a light hub; see the model's limits.
            if (basis == Basis::cantilever && modes > 6) continue;
            runs.push_back({basis, modes, problem});
            set_shapes(runs.back().problem, sim::ModelKind::first_order, basis, modes);
        }
    return runs;
}

Panel apex_panel(std::array<Series, 2> series, Lang lang) {
    const bool en = lang == Lang::en;
    series[0].label = en ? "hub–beam shapes" : "轮毂–梁模态";
    series[1].label = en ? "cantilever shapes" : "悬臂模态";
    series[1].look = 1;
    Panel panel;
    panel.x.label = "$N$";
    panel.x.tight = false;
    panel.x.counts = true;
    panel.y.label = "$θ_{\\r{apex}}$ / rad";
    panel.legend = Legend::box;
    for (Series& s : series) s.every_point = true, panel.series.push_back(std::move(s));
    return panel;
}

FigureMaker prepare_apex(const Scene& scene, const FigureOutput& how, Studies& studies) {
    std::vector<ApexRun> runs = apex_runs(scene.problem);
    for (ApexRun& run : runs) {
        run.study = studies.of(run.problem, scene.end_time, "apex-modes");
        studies.turning_points(run.study);
        studies.may_fail(run.study);
    }
    return [runs, lang = how.lang, problem = scene.problem, end = scene.end_time](const Results& results) {
        const bool en = lang == Lang::en;
        std::array<Series, 2> series;  // hub–beam, cantilever
        std::vector<std::pair<const sim::Problem*, const sim::Result*>> used;
        for (const ApexRun& run : runs) {
            const std::optional<double> apex = rebound_apex(*results[run.study], end);
            if (!apex) continue;  // none, or no such motion
            Series& s = series[run.basis == Basis::hub_beam ? 0 : 1];
            s.x.push_back(run.modes);
            s.y.push_back(*apex);
            used.emplace_back(&run.problem, results[run.study]);
        }
        if (used.empty())
            throw render::PictureError(
                "figure apex-modes: no rebound has an apex before the scene ends; raise time.end");
        Figure figure;
        figure.name = "apex-modes";
        figure.title = en ? "Rebound apex against the number of modes" : "回弹最高点随模态数的变化";
        figure.panels.push_back(apex_panel(std::move(series), lang));
        figure.aspect = 0.62;
        figure.caption =
            en ? "Apex of the hub angle after the first collision against the number $N$ of shape functions, model "
                 "first-order. "
               : "首次碰撞后转角的最高点随形函数个数 $N$ 的变化，模型 first-order。";
        figure.caption += facts(problem, lang, {.model = true, .modes = true});
        figure.accuracy = accuracy(used, lang);
        return figure;
    };
}

std::optional<std::string> needs_free_cam(const Scene& scene) {
    if (auto no_cam = needs_cam(scene)) return no_cam;
    return needs_free_hub(scene);
}

}  // namespace

const Recipe kApexModes{"apex-modes",
                        {"Rebound apex against the number of modes", "回弹最高点随模态数的变化"},
                        needs_free_cam,
                        prepare_apex};

}  // namespace beamcam::scenes
