// The models of the beam compared: how much the choice of model matters.
#include <fmt/format.h>

#include <cmath>

#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"

namespace beamcam::scenes {
namespace {

using render::Scale;
using sim::Basis;
using sim::ModelKind;

constexpr int kModelsPoints = 4001;

// The budget of steps of a motion: about a second of computing, from the time of a Runge–Kutta step with N shapes.
int affordable_steps(ModelKind model, int modes) {
    const bool nonlinear = model == ModelKind::second_order || model == ModelKind::exact;
    const double microseconds = 40 + (nonlinear ? 2.0 : 0.5) * modes * modes;
    return static_cast<int>(1.2e6 / microseconds);
}

// One motion of the comparison.
struct Rung {
    ModelKind model;
    Basis basis;
    bool same_shapes;  // as the reference, so that only the model differs
    std::string label;
    sim::Problem problem = {};
    std::size_t study = 0, table = 0;
};

// The reference first. Models are compared in the same shapes and number of modes; the paper's equation, which only the
// paper's scenes show, has cantilever shapes only. The effect of other shapes is shown separately.
std::vector<Rung> rungs(const Scene& scene, Lang lang) {
    const sim::Problem& problem = scene.problem;
    const bool paper = is_of_the_paper(problem) || problem.beam.model == ModelKind::paper;
    const Basis own = problem.beam.basis == Basis::cantilever || paper ? Basis::cantilever : Basis::hub_beam,
                other = own == Basis::cantilever ? Basis::hub_beam : Basis::cantilever;
    std::vector<Rung> all;
    for (const ModelKind model :
         {ModelKind::second_order, ModelKind::first_order, ModelKind::zeroth_order, ModelKind::paper, ModelKind::rigid})
        if (model != ModelKind::paper || paper) all.push_back({model, own, true, model_name(model, lang)});
    all.push_back({ModelKind::second_order, other, false,
                   phrase(lang, "second-order, {} shapes", "二阶模型，{}模态", shapes_name(other, lang))});
    all.push_back({ModelKind::exact, Basis::automatic, false, model_name(ModelKind::exact, lang)});
    for (Rung& rung : all) {
        rung.problem = problem;
        const sim::Beam& beam = rung.problem.beam;
        // The elastica's own shapes resolve what the scene's modes do with about twice as many.
        const int shapes = rung.model == ModelKind::exact ? std::min(2 * beam.modes + 1, 40) : beam.modes;
        set_shapes(rung.problem, rung.model, rung.basis, shapes);
        int& steps = rung.problem.solver.max_steps;
        if (rung.model != ModelKind::rigid) steps = std::min(steps, affordable_steps(beam.model, beam.modes));
    }
    return all;
}

const Rung* found(const std::vector<Rung>& all, ModelKind model, bool same_shapes) {
    const auto it =
        std::ranges::find_if(all, [&](const Rung& r) { return r.model == model && r.same_shapes == same_shapes; });
    return it == all.end() ? nullptr : &*it;
}

// Names the curves that end before the scene.
std::string cut_short(const std::vector<Rung>& all, const Results& results, double end, Lang lang) {
    std::vector<std::string> ends;
    for (const Rung& rung : all)
        if (const sim::Result& result = *results[rung.study]; has_result(result) && result.end_time < end)
            ends.push_back(phrase(lang, "{} ends at {} s", "{} 止于 {} s", rung.label, number(result.end_time, 3)));
    if (ends.empty()) return {};
    return phrase(lang,
                  "Curves end where the computing budget of this figure for a model is spent, or where the model "
                  "cannot be integrated further: {}. ",
                  "曲线止于本图为每一模型所用计算量的终点，或模型无法继续之处：{}。", listed(ends, lang));
}

// States how equation and shapes, each alone, change the first rebound.
std::string models_caption(const std::vector<Rung>& all, const Results& results, const Subject& subject) {
    const Lang lang = subject.lang;
    const auto apex = [&](ModelKind model, bool same_shapes) -> std::optional<double> {
        const Rung* rung = found(all, model, same_shapes);
        return rung ? rebound_apex(rung->problem, *results[rung->study], subject.end_time) : std::nullopt;
    };
    const auto difference = [&](double a, double b, int digits) {
        const Measure angle = measure_in(subject.units, "rad");
        return with_unit(number(angle.factor * std::abs(a - b), digits), angle.unit);
    };
    const Rung& reference = all.front();
    std::string text = phrase(
        lang,
        "The models of the beam compared: (a) hub angle; (b) largest difference so far from the model "
        "second-order, with {0} {1} modes in all models, so that only the model differs; (c) the same difference "
        "for other shapes: {2} modes, and the polynomials of the model exact (inextensible elastica). ",
        "各梁模型比较：(a) 转角；(b) 与二阶模型之差迄今的最大值，均用 {0} "
        "个{1}模态，故仅为模型之差；(c) "
        "其他形函数的同一差值：{2}模态，以及精确模型（不可伸长弹性线）的多项式。",
        reference.problem.beam.modes, shapes_name(reference.basis, lang),
        shapes_name(found(all, ModelKind::second_order, false)->basis, lang));
    const auto reference_apex = apex(ModelKind::second_order, true), other_apex = apex(ModelKind::second_order, false),
               first = apex(ModelKind::first_order, true), printed = apex(ModelKind::paper, true);
    if (found(all, ModelKind::paper, true))
        text +=
            phrase(lang,
                   "The model “paper” is the paper's eq. (4) as printed, with the sign of gravity from its eq. (2); "
                   "it does not conserve energy. ",
                   "论文模型为原文式 (4)，仅重力符号取自式 (2)，其能量不守恒。");
    if (first && printed)
        text += phrase(lang, "The apex of the first rebound differs by {} between eq. (4) and first-order. ",
                       "式 (4) 与一阶模型的首次回弹最高点相差 {}。", difference(*first, *printed, 1));
    if (reference_apex && other_apex)
        text +=
            phrase(lang,
                   "The other shapes change the apex of the first rebound by {}; this is an effect of the "
                   "shapes, not of the equations. ",
                   "更换形函数使首次回弹最高点改变 {}，这并非方程之差。", difference(*reference_apex, *other_apex, 2));
    if (!results[reference.study]->impacts.empty())
        text += phrase(lang, "Impacts multiply small differences. ", "碰撞会放大微小差别。");
    return text + cut_short(all, results, subject.end_time, lang) + facts(subject, {.model = true, .modes = true});
}

// The largest difference from the reference up to each instant; empty where there is none.
Series largest_difference(Series s, const std::vector<double>& reference) {
    s.x.resize(std::min(s.x.size(), reference.size()));
    s.y.resize(s.x.size());
    double largest = 0;
    for (std::size_t i = 0; i < s.y.size(); ++i) {
        largest = std::max(largest, std::abs(s.y[i] - reference[i]));
        s.y[i] = largest > 0 ? largest : std::nan("");
    }
    if (largest == 0) s.x.clear(), s.y.clear();
    return s;
}

// The hub angle of each model, and its difference from the first: for equal shapes, and for others.
std::vector<Panel> model_panels(const std::vector<Rung>& all, const Results& results, const render::Units& units,
                                double end) {
    const Measure shown = measure_in(units, "rad");
    const render::Axis time{.label = "$t$ / s", .from = 0, .to = end, .tight = true};
    const Panel difference{.x = time,
                           .y = {.label = axis_label("max |$Δθ$|", shown.unit), .scale = Scale::logarithmic},
                           .legend = Legend::none};
    Panel angle{.x = time, .y = {.label = axis_label("$θ$", shown.unit)}, .legend = Legend::box, .share = 1.4},
        models = difference, bases = difference;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const Rung& rung = all[k];
        if (!has_result(*results[rung.study])) continue;
        const sim::Table& table = results[rung.study]->tables[rung.table];
        Series s{.label = rung.label,
                 .x = column(table, ChannelKind::t),
                 .y = scaled(column(table, ChannelKind::theta), shown.factor),
                 .look = k == 0 ? 6 : static_cast<int>(k) - 1,
                 .solid = k == 0,
                 .weight = 0.85};
        // Rows after the end of a motion that was cut short are not numbers.
        s.x.erase(std::ranges::find_if(s.x, [](double t) { return std::isnan(t); }), s.x.end());
        s.y.resize(s.x.size());
        if (k > 0)
            if (Series d = largest_difference(s, angle.series.front().y); !d.x.empty())
                (rung.same_shapes ? models : bases).series.push_back(std::move(d));
        angle.series.push_back(std::move(s));
    }
    std::vector<Panel> panels{std::move(angle), std::move(models), std::move(bases)};
    for (std::size_t k = 0; k < panels.size(); ++k) panels[k].letter = panel_letter(k);
    std::erase_if(panels, [](const Panel& panel) { return panel.series.empty(); });
    return panels;
}

// Until the last of the flexible beams ends: beyond it the rigid beam has nothing to compare with.
double shown_until(const std::vector<Rung>& all, const Results& results) {
    double shown = 0;
    for (const Rung& rung : all)
        if (rung.model != ModelKind::rigid) shown = std::max(shown, results[rung.study]->end_time);
    return shown;
}

FigureDrawing prepare_models(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const Lang lang = how.lang;
    std::vector<Rung> all = rungs(scene, lang);
    for (Rung& rung : all) {
        rung.study = studies.of(rung.problem, scene.end_time);
        studies.may_fail(rung.study);
        studies.apexes(rung.study);
        rung.table =
            studies.table(rung.study, {0, scene.end_time, kModelsPoints}, {ChannelKind::t, ChannelKind::theta});
    }
    return [all](const Subject& subject, const Results& results) -> Figure {
        if (!has_result(*results[all[0].study]))
            throw render::PictureError(
                "figure models: the model second-order, with which the others are compared, "
                "cannot be integrated; its warning says why");
        Runs runs;
        for (const Rung& rung : all)
            if (has_result(*results[rung.study])) runs.emplace_back(&rung.problem, results[rung.study]);
        return {.panels = model_panels(all, results, subject.units, shown_until(all, results)),
                .stack = true,
                .share_x = true,
                .aspect = 1.5,
                .caption = models_caption(all, results, subject),
                .accuracy = accuracy(runs, subject.lang)};
    };
}

std::optional<std::string> needs_flexible_fall(const Scene& scene) {
    if (auto prescribed = needs_free_hub(scene)) return prescribed;
    if (scene.problem.beam.model != ModelKind::rigid) return std::nullopt;
    return "the comparison starts from a flexible beam; choose another beam.model than \"rigid\"";
}

}  // namespace

extern const FigureType kModels{"models", {"The models compared", "各模型比较"}, needs_flexible_fall, prepare_models};

}  // namespace beamcam::scenes
