#include <fmt/format.h>

#include <algorithm>

#include "render/base/error.hpp"
#include "scenes/figures/command_figures.hpp"
#include "scenes/figures/figure_types.hpp"

namespace beamcam::scenes {
namespace {

using render::Scale;

// The angle that the errors are of.
const char* angle(const sim::Accuracy& a) { return a.of_tip ? "$δ/L$" : "$θ$"; }
std::string error_label(const sim::Accuracy& a, Lang lang) { return phrase(lang, "error of {} / rad", angle(a)); }

// A logarithmic axis has no zero: an error below that of the reference is drawn at the latter.
double visible(double error, const sim::Accuracy& a) { return std::max(error, a.reference_error); }

// The points of one method in the order of its tolerances, at the median of the repeated timings.
void add_method(Panel& panel, const sim::Accuracy& a, sim::Method method, int look) {
    Series points{.label = sim::name(method), .look = look, .every_point = true};
    for (const sim::WorkRow& row : a.work) {
        if (row.method != method || !row.error || row.time.repeats == 0) continue;
        points.add(1e3 * row.time.median, visible(*row.error, a));
    }
    if (!points.x.empty()) panel.series.push_back(std::move(points));
}

Panel work_precision(const sim::Accuracy& a, Lang lang) {
    Panel panel{.x = {.label = phrase(lang, "run time / ms"), .scale = Scale::logarithmic},
                .y = {.label = error_label(a, lang), .scale = Scale::logarithmic},
                .rules = {{.at = a.reference_error, .label = phrase(lang, "reference")},
                          {.at = a.target, .label = phrase(lang, "target")}},
                .name = "work-precision"};
    std::vector<sim::Method> methods;
    for (const sim::WorkRow& row : a.work)
        if (std::ranges::find(methods, row.method) == methods.end()) methods.push_back(row.method);
    for (std::size_t k = 0; k < methods.size(); ++k) add_method(panel, a, methods[k], static_cast<int>(k));
    return panel;
}

Panel mode_counts(const sim::Accuracy& a, Lang lang) {
    Panel panel{.title = phrase(lang, "error, against $N$ = {}", a.most_modes),
                .x = {.label = "$N$", .counts = true},
                .y = {.label = error_label(a, lang), .scale = Scale::logarithmic},
                .series = {{.name = "error", .every_point = true}},
                .name = "modes"};
    for (const sim::ModesRow& row : a.modes)
        if (row.error && row.modes != a.most_modes) panel.series[0].add(row.modes, visible(*row.error, a));
    return panel;
}

}  // namespace

Figure accuracy_figure(const sim::Accuracy& a, const Subject& subject) {
    const Lang lang = subject.lang;
    std::vector<Panel> panels{work_precision(a, lang)};
    if (panels.front().series.empty())
        throw render::PictureError("accuracy: no run ended, so there is nothing to draw");
    Panel modes = mode_counts(a, lang);
    if (!modes.series[0].x.empty()) panels.push_back(std::move(modes));
    const double aspect = panels.size() > 1 ? 1.5 : 0.8;
    Figure figure{.name = "accuracy",
                  .title = fmt::format("Largest error of {} in the first {} s", angle(a), number(a.until, 4)),
                  .panels = lettered(std::move(panels)),
                  .aspect = aspect};
    add_caption(figure, std::vector{subject.problem}, subject.units);
    figure.accuracy = fmt::format("The reference, {} at 10^{{−13}}, is good to about {} rad.",
                                  sim::name(a.reference_method), number(a.reference_error, 1));
    return figure;
}

}  // namespace beamcam::scenes
