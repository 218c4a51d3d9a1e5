// The figure "series" draws any channels against the time, the turns of the cam or another channel, of one motion or of
// several.
#include "scenes/figures/series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "scenes/figures/figure_types.hpp"

namespace beamcam::scenes {
namespace {

// Gives the panels of several motions one scale, so that they compare.
void share_ordinates(Figure& figure) {
    std::map<std::string, render::Extent> ranges;  // by what the panels show
    for (const Panel& panel : figure.panels)
        for (const Series& curve : panel.series) ranges[panel.name].add(curve.y);
    const auto share = [](render::Axis& axis, const render::Extent& range) {
        const double air = 0.05 * (range.high - range.low);
        if (!(range.high > range.low) || axis.scale == render::Scale::logarithmic) return;
        axis.from = axis.from.value_or(range.low - air), axis.to = axis.to.value_or(range.high + air);
    };
    for (Panel& panel : figure.panels) {
        share(panel.y, ranges[panel.name]);
    }
}

// Names the data and the vertical lines without a text.
std::string series_marks(const SeriesPlan& plan, const Figure& figure) {
    std::string text;
    for (const Measured& each : plan.measured) text += fmt::format(" Data: {}.", each.data.label);
    const bool lines = std::ranges::any_of(figure.panels, [](const Panel& panel) {
        return std::ranges::any_of(panel.rules, [](const auto& rule) { return rule.vertical && rule.label.empty(); });
    });
    if (lines && plan.keys.notes.empty())
        text += plan.keys.impacts ? " Vertical dashed lines: the beam touches the cam."
                                  : " Vertical dashed lines: where curves become paler, or are so no longer.";
    return text;
}

Figure series_figure(const SeriesPlan& plan, const MotionResults& results) {
    std::vector<Panel> panels;
    const std::vector<int> looks = looks_of_motions(plan, results);
    for (const PlannedPanel& planned : plan.panels)
        std::ranges::move(series_panels(plan, planned, results, looks), std::back_inserter(panels));
    const auto stands = [](const Panel& panel) {
        return std::ranges::all_of(panel.series,
                                   [](const Series& s) { return std::ranges::min(s.x) == std::ranges::max(s.x); });
    };
    if (plan.abscissa.channel() && std::ranges::all_of(panels, stands))
        throw render::PictureError(fmt::format("series: {} does not change from {:g} s to {:g} s; choose another \"x\"",
                                               name(*plan.abscissa.channel()), plan.keys.from, plan.end));
    Figure figure{
        .title = series_title(plan.keys), .panels = lettered(std::move(panels)), .stack = true, .share_x = true};
    plan.abscissa.share(figure, plan.motions.front().problem, plan.units);
    if (plan.panels.size() > plan.keys.panels.size()) share_ordinates(figure);
    figure.aspect = 0.2 + 0.36 * static_cast<double>(figure.panels.size());
    Runs runs;
    for (const SeriesMotion& motion : plan.motions) runs.emplace_back(&motion.problem, results[motion.request]);
    add_caption(figure, runs, plan.units);
    figure.accuracy += series_marks(plan, figure);
    return figure;
}

// Points are taken where the limits of a time axis show them.
void keep_within_limits(SeriesPlan& plan) {
    const SeriesKeys& keys = plan.keys;
    if (keys.against != "t") return;
    const double from = std::max(keys.from, keys.x_low.value_or(keys.from)),
                 end = std::min(plan.end, keys.x_high.value_or(plan.end));
    if (from < end) plan.keys.from = from, plan.end = end;
}

FigureDrawing prepare_series(const Scene& scene, const FigureOutput& how, MotionRequests& requests) {
    SeriesKeys keys = how.series;
    if (keys.panels.empty()) keys.panels = {{.channels = {{ChannelKind::theta, 0}}}};
    SeriesPlan plan{keys, how.lang, keys.to.value_or(scene.end_time), SeriesAbscissa(keys, how.lang), scene.units};
    keep_within_limits(plan);
    complete(plan, scene, requests);
    return [plan](const Subject&, const MotionResults& results) { return series_figure(plan, results); };
}

}  // namespace

extern const FigureType kSeries{.name = "series",
                                .title = "Any channels, of one motion or of several",
                                .refusal = no_refusal,
                                .maker = prepare_series,
                                .keys = {"channels", "panels", "x", "x_low", "x_high", "x_label", "x_unit", "from",
                                         "to", "impacts", "notes", "compare", "comparison", "residuals", "horizon"}};

}  // namespace beamcam::scenes
