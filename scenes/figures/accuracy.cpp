#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "render/base/error.hpp"
#include "scenes/figures/command_figures.hpp"
#include "scenes/figures/figure_types.hpp"

namespace beamcam::scenes {
namespace {

using render::Axis;
using render::Scale;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr Translated kTime{"run time / ms", "计算时间 / ms"};

// The angle that the errors are of.
const char* angle(const sim::Accuracy& a) { return a.of_tip ? "$δ/L$" : "$θ$"; }
std::string error_label(const sim::Accuracy& a, Lang lang) {
    return phrase(lang, "error of {} / rad", "{} 的误差 / rad", angle(a));
}

// A logarithmic axis has no zero: an error below that of the reference is drawn at the latter.
double visible(double error, const sim::Accuracy& a) { return std::max(error, a.reference_error); }

// The points of one method and, behind them, the range of the repeated timings.
void add_method(Panel& panel, const sim::Accuracy& a, sim::Method method, int look) {
    Series points{.label = sim::name(method), .look = look, .every_point = true},
        spread{.name = points.label + ", range of run time", .look = look, .solid = true, .weight = 0.6};
    for (const sim::WorkRow& row : a.work) {
        if (row.method != method || !row.error || row.time.repeats == 0) continue;
        const double error = visible(*row.error, a);
        points.add(1e3 * row.time.median, error);
        for (const double seconds : {row.time.low, row.time.high, kNone}) spread.add(1e3 * seconds, error);
    }
    if (points.x.empty()) return;
    panel.series.push_back(std::move(spread));
    panel.series.push_back(std::move(points));
}

Panel work_precision(const sim::Accuracy& a, Lang lang) {
    Panel panel{.x = {.label = kTime.in(lang), .scale = Scale::logarithmic},
                .y = {.label = error_label(a, lang), .scale = Scale::logarithmic},
                .rules = {{.at = a.reference_error, .label = phrase(lang, "reference", "参考解")},
                          {.at = a.target, .label = phrase(lang, "target", "目标")}},
                .legend = Legend::box,
                .name = "work-precision"};
    std::vector<sim::Method> methods;
    for (const sim::WorkRow& row : a.work)
        if (std::ranges::find(methods, row.method) == methods.end()) methods.push_back(row.method);
    for (std::size_t k = 0; k < methods.size(); ++k) add_method(panel, a, methods[k], static_cast<int>(k));
    return panel;
}

Panel mode_counts(const sim::Accuracy& a, Lang lang) {
    Panel panel{.x = {.label = "$N$", .counts = true},
                .y = {.label = error_label(a, lang), .scale = Scale::logarithmic},
                .right = Axis{.label = kTime.in(lang), .scale = Scale::logarithmic},
                .legend = Legend::box,
                .name = "modes"};
    Series error{.label = phrase(lang, "error, against $N$ = {}", "误差（相对 $N$ = {}）", a.most_modes),
                 .every_point = true},
        time{
            .label = phrase(lang, "run time (right)", "计算时间（右）"), .look = 1, .every_point = true, .right = true};
    for (const sim::ModesRow& row : a.modes) {
        if (!row.error) continue;
        if (row.modes != a.most_modes) error.add(row.modes, visible(*row.error, a));
        if (row.time.repeats > 0) time.add(row.modes, 1e3 * row.time.median);
    }
    if (!error.x.empty()) panel.series.push_back(std::move(error));
    if (!time.x.empty()) panel.series.push_back(std::move(time));
    return panel;
}

// The parts of the error budget that have no panel.
std::string budget(const sim::Accuracy& a, Lang lang) {
    std::string models, text;
    for (const sim::ModelRow& row : a.models)
        if (row.error && row.model != a.best_model)
            models += fmt::format("{}{} {} rad", models.empty() ? "" : ", ", model_name(row.model, lang),
                                  number(*row.error, 2));
    if (!models.empty())
        text += phrase(lang, " Within {1} s the models of the beam differ from {0} by: {2}.",
                       "前 {1} s 内各梁模型与{0}的差：{2}。", model_name(a.best_model, lang), number(a.models_until, 3),
                       models);
    std::string contact;
    for (const sim::ContactRow& row : a.contact)
        if (row.error)
            contact += fmt::format("{}{}: {} rad", contact.empty() ? "" : "; ", row.change, number(*row.error, 2));
    if (!contact.empty())
        text += phrase(lang, " Changes of the contact law change {} by: {}.", "接触参数的变化引起的 {} 的改变：{}。",
                       angle(a), contact);
    return text;
}

}  // namespace

Figure accuracy_figure(const sim::Accuracy& a, const sim::Problem& problem, Lang lang) {
    std::vector<Panel> panels{work_precision(a, lang)};
    if (panels.front().series.empty())
        throw render::PictureError("accuracy: no run ended, so there is nothing to draw");
    Panel modes = mode_counts(a, lang);
    if (modes.series.size() == 2) panels.push_back(std::move(modes));
    const double aspect = panels.size() > 1 ? 1.5 : 0.8;
    const std::string model =
        problem.beam.model == sim::ModelKind::rigid
            ? model_name(problem.beam.model, lang)
            : phrase(lang, "{}, $N$ = {} {} shapes", "{}，{} 个{}模态", model_name(problem.beam.model, lang),
                     problem.beam.modes, shapes_name(resolved_basis(problem), lang));
    int repeats = 0;
    double loosest = 0, tightest = 1;
    for (const sim::WorkRow& row : a.work) {
        repeats = std::max(repeats, row.time.repeats);
        loosest = std::max(loosest, row.rtol);
        tightest = std::min(tightest, row.rtol);
    }
    return {
        .name = "accuracy",
        .title = phrase(lang, "Error against run time", "误差与计算时间"),
        .panels = lettered(std::move(panels)),
        .aspect = aspect,
        .caption = phrase(
            lang,
            "Largest error of {} in the first {} s against the run time on one core, the median of up to {} runs "
            "with their range, for relative tolerances from {} to {}; the reference is rk8 at 10^{{−13}}. Model {}.{}",
            "{} 在前 {} s 内的最大误差与单核计算时间（至多 {} 次运行的中位数及范围），相对容差 {} 至 {}；参考解为 "
            "rk8，容差 "
            "10^{{−13}}。{}。{}",
            angle(a), number(a.until, 4), repeats, number(loosest, 1), number(tightest, 1), model, budget(a, lang)),
        .accuracy = phrase(lang, "The reference is good to about {} rad.", "参考解自身误差约 {} rad。",
                           number(a.reference_error, 1))};
}

}  // namespace beamcam::scenes
