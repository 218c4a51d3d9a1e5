// How much the choice of model matters: number of modes, rungs of the ladder.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "scenes/figures/recipes.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::Figure;
using render::figure::Legend;
using render::figure::Panel;
using render::figure::Scale;
using render::figure::Series;
using sim::Basis;
using sim::ChannelKind;
using sim::ModelKind;

constexpr std::array kModes{1, 2, 3, 4, 5, 6, 8};
constexpr int kCurve = 4001;

// The first apex after the first collision began.
std::optional<double> rebound(const sim::Result& result) {
    if (result.collisions.empty()) return std::nullopt;
    const double after = result.collisions.front().t_end.value_or(result.end_time);
    // Ripple makes small maxima; the rebound is the highest of those before the next collision.
    const double until = result.collisions.size() > 1 ? result.collisions[1].t_start : result.end_time;
    std::optional<double> best;
    for (const sim::Apex& apex : result.apexes)
        if (apex.t > after && apex.t < until && (!best || apex.theta > *best)) best = apex.theta;
    return best;
}

FigureMaker prepare_apex(const Scene& scene, Lang lang, Studies& studies) {
    struct Run {
        Basis basis;
        int modes;
        std::size_t study;
        sim::Problem problem;
    };
    std::vector<Run> runs;
    for (const Basis basis : {Basis::hub_beam, Basis::cantilever})
        for (const int modes : kModes) {
            sim::Problem p = scene.problem;
            p.beam.model = ModelKind::first_order;
            p.beam.basis = basis;
            p.beam.modes = modes;
            if (p.beam.damping_ratio.size() > 1) p.beam.damping_ratio.resize(static_cast<std::size_t>(modes), 0);
            // Cantilever shapes with many modes lose the inertia of a light hub; see the model's limits.
            if (basis == Basis::cantilever && modes > 6) continue;
            runs.push_back({basis, modes, studies.of(p, scene.end_time, "apex-modes"), p});
            studies.turning_points(runs.back().study);
            studies.may_fail(runs.back().study);
        }
    return [runs, lang, problem = scene.problem](const Results& results) {
        const bool en = lang == Lang::en;
        Figure figure;
        figure.name = "apex-modes";
        figure.title = en ? "Rebound apex against the number of modes" : "回弹最高点随模态数的变化";
        Panel panel;
        panel.x.label = "$N$";
        panel.x.tight = false;
        panel.x.counts = true;
        panel.y.label = "$θ_{\\r{apex}}$ / rad";
        panel.legend = Legend::box;
        std::array<Series, 2> series;
        series[0].label = en ? "hub–beam shapes" : "轮毂–梁模态";
        series[1].label = en ? "cantilever shapes" : "悬臂模态";
        series[1].look = 1;
        std::vector<std::pair<const sim::Problem*, const sim::Result*>> used;
        for (const Run& run : runs) {
            const std::optional<double> apex = rebound(*results[run.study]);
            if (!apex) continue;  // none, or no such motion
            Series& s = series[run.basis == Basis::hub_beam ? 0 : 1];
            s.x.push_back(run.modes);
            s.y.push_back(*apex);
            used.emplace_back(&run.problem, results[run.study]);
        }
        if (used.empty())
            throw render::PictureError(
                "figure apex-modes: no rebound has an apex before the scene ends; raise time.end");
        for (Series& s : series) s.every_point = true, panel.series.push_back(s);
        figure.panels.push_back(std::move(panel));
        figure.aspect = 0.62;
        sim::Problem shown = problem;
        shown.beam.model = ModelKind::first_order;
        figure.caption =
            en ? "Apex of the hub angle after the first collision against the number $N$ of shape functions, "
                 "model first-order; models and modes of the following list do not apply. "
               : "首次碰撞后转角的最高点随形函数个数 $N$ 的变化，模型 first-order（下列模型与模态数不适用）。";
        figure.caption += stated(shown, lang);
        figure.accuracy = accuracy(used, lang);
        return figure;
    };
}

FigureMaker prepare_models(const Scene& scene, Lang lang, Studies& studies) {
    constexpr std::array kLadder{ModelKind::second_order, ModelKind::exact, ModelKind::first_order,
                                 ModelKind::zeroth_order, ModelKind::paper, ModelKind::rigid};
    std::vector<std::size_t> where, tables;
    std::vector<sim::Problem> problems;
    for (const ModelKind model : kLadder) {
        sim::Problem p = scene.problem;
        p.beam.model = model;
        if (model == ModelKind::paper) p.beam.basis = Basis::cantilever;
        if (model == ModelKind::exact) {
            // The elastica's own shapes resolve what the scene's modes do with about twice as many.
            p.beam.modes = std::min(2 * scene.problem.beam.modes + 1, 40);
            if (p.beam.damping_ratio.size() > 1) p.beam.damping_ratio.clear();
        }
        where.push_back(studies.of(p, scene.end_time, "models"));
        if (model != ModelKind::second_order) studies.may_fail(where.back());  // what the others are compared with
        tables.push_back(
            studies.table(where.back(), {0, scene.end_time, kCurve}, {ChannelKind::t, ChannelKind::theta}));
        problems.push_back(std::move(p));
    }
    return [=, problem = scene.problem, end = scene.end_time](const Results& results) {
        const bool en = lang == Lang::en;
        Figure figure;
        figure.name = "models";
        figure.title = en ? "The models compared" : "各模型比较";
        Panel angle, difference;
        angle.letter = "a";
        difference.letter = "b";
        angle.x.label = difference.x.label = "$t$ / s";
        angle.y.label = "$θ$ / rad";
        difference.y.label = "max |$Δθ$| / rad";
        difference.y.scale = Scale::logarithmic;
        angle.legend = Legend::box;
        difference.legend = Legend::none;
        std::vector<std::pair<const sim::Problem*, const sim::Result*>> runs;
        const std::vector<double>& reference = column(results[where[0]]->tables[tables[0]], ChannelKind::theta);
        for (std::size_t k = 0; k < where.size(); ++k) {
            if (!is_there(*results[where[k]])) continue;
            const sim::Table& t = results[where[k]]->tables[tables[k]];
            Series s;
            s.label = name(kLadder[k]);
            s.look = k == 0 ? 6 : static_cast<int>(k) - 1;
            s.solid = k == 0;
            s.weight = 0.85;
            s.x = column(t, ChannelKind::t);
            s.y = column(t, ChannelKind::theta);
            if (k > 0) {
                Series d = s;
                double largest = 0;
                for (std::size_t i = 0; i < d.y.size(); ++i) {
                    largest = std::max(largest, std::abs(d.y[i] - reference[i]));
                    d.y[i] = largest > 0 ? largest : std::nan("");
                }
                difference.series.push_back(std::move(d));
            }
            angle.series.push_back(std::move(s));
            runs.emplace_back(&problems[k], results[where[k]]);
        }
        for (Panel* panel : {&angle, &difference}) panel->x.from = 0, panel->x.to = end;
        figure.panels = {angle, difference};
        figure.stack = true;
        figure.share_x = true;
        figure.aspect = 1.15;
        figure.caption =
            en ? "The rungs of the model ladder compared: (a) hub angle, (b) the largest difference so far "
                 "from the model second-order. The model exact (inextensible elastica) has shapes of its own, "
                 "so its difference is that of the shapes too. The model “paper” is the paper's eq. (4) as printed, "
                 "with the "
                 "sign of gravity from its eq. (2); it does not conserve energy. After an impact small "
                 "differences grow as the motion is chaotic. "
               : "各级模型比较：(a) 转角，(b) 与 second-order "
                 "模型之差迄今的最大值。exact（不可伸长弹性线）模型使用自己的形函数，其差别亦含形函数的差别。模型 "
                 "paper 为原文式 (4)，仅重力符号取自式 (2)，其能量"
                 "不守恒。碰撞之后由于混沌，微小差别会增长。";
        figure.caption += stated(problem, lang);
        figure.accuracy = accuracy(runs, lang);
        return figure;
    };
}

std::optional<std::string> needs_free_cam(const Scene& scene) {
    if (auto no_cam = needs_cam(scene)) return no_cam;
    return needs_free_hub(scene);
}
std::optional<std::string> needs_flexible(const Scene& scene) {
    if (auto prescribed = needs_free_hub(scene)) return prescribed;
    if (scene.problem.beam.model != ModelKind::rigid) return std::nullopt;
    return "the ladder starts from a flexible beam; choose another beam.model than \"rigid\"";
}

}  // namespace

const Recipe kApexModes{"apex-modes",
                        {"Rebound apex against the number of modes", "回弹最高点随模态数的变化"},
                        needs_free_cam,
                        prepare_apex};
const Recipe kModels{"models", {"The models compared", "各模型比较"}, needs_flexible, prepare_models};

}  // namespace beamcam::scenes
