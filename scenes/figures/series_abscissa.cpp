#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "render/plot/channel_label.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/figures/series.hpp"

namespace beamcam::scenes {

using sim::Channel;

namespace {

constexpr double kShort = 0.05;  // an interval whose axis is in milliseconds [s]
constexpr double kAir = 0.03;    // beside the curves, of their extent

}  // namespace

SeriesAbscissa::SeriesAbscissa(const SeriesKeys& keys, Lang lang)
    : against_(keys.against),
      low_(keys.x_low),
      high_(keys.x_high),
      label_(keys.x_label),
      unit_(keys.x_unit),
      lang_(lang) {
    if (const auto named = sim::channel_named(against_); named && named->kind != ChannelKind::t) channel_ = *named;
}

std::vector<double> SeriesAbscissa::of(const sim::Table& table, const sim::Problem& problem) const {
    if (channel_) return table.values[1];
    return scaled(table.values[0], per_second(problem));
}

std::optional<std::vector<double>> SeriesAbscissa::of(const Measurement& data, const sim::Problem& problem) const {
    if (!channel_) return scaled(data.times, per_second(problem));
    if (const std::vector<double>* held = data.find(*channel_)) return *held;
    if (channel_->kind != ChannelKind::cam_angle || !problem.cam) return std::nullopt;
    std::vector<double> angles;
    for (const double t : data.times) angles.push_back(problem.cam->phase - problem.cam->speed * t);
    return angles;
}

double SeriesAbscissa::per_second(const sim::Problem& problem) const {
    if (!is_turns() && !is_phase()) return 1;
    return problem.cam ? std::abs(problem.cam->speed) / (2 * std::numbers::pi) : 0;
}

std::pair<double, double> SeriesAbscissa::drawn(const sim::Problem& problem) const {
    const std::pair<double, double> all = sim::TableRequest().drawn;
    if (is_phase() || against_ == "t") return all;  // not folded yet; the rows lie within limits of time
    const double unit = channel_ ? 1 : per_second(problem);
    return {low_ ? *low_ / unit : all.first, high_ ? *high_ / unit : all.second};
}

void SeriesAbscissa::fold(Series& curve) const {
    if (!is_phase()) return;
    const Series whole = curve;
    const bool timed = whole.t.size() == whole.x.size();
    curve.x.clear(), curve.y.clear(), curve.t.clear();
    for (std::size_t i = 0; i < whole.x.size(); ++i) {
        const double now = whole.x[i], before = i > 0 ? whole.x[i - 1] : now;
        if (whole.line && std::floor(now) != std::floor(before)) {
            const double edge = std::floor(now);  // between them: rows are closer than turns
            const double y = whole.y[i - 1] + (whole.y[i] - whole.y[i - 1]) * (edge - before) / (now - before);
            curve.add(1, y), curve.add(std::nan(""), std::nan("")), curve.add(0, y);
            if (timed)
                curve.t.resize(curve.x.size(),
                               whole.t[i - 1] + (whole.t[i] - whole.t[i - 1]) * (edge - before) / (now - before));
        }
        curve.add(now - std::floor(now), whole.y[i]);
        if (timed) curve.t.push_back(whole.t[i]);
    }
}

void SeriesAbscissa::share(Figure& figure, const sim::Problem& problem, const render::Units& units) const {
    render::Extent range;
    for (const Panel& each : figure.panels)
        for (const Series& curve : each.series) range.add(curve.x);
    double largest = std::max(std::abs(range.low), std::abs(range.high));
    // A logarithmic panel omits what is not positive, but has the same axis.
    // None at a limit, or where time begins at zero.
    const double air = !channel_ && range.low == 0 ? 0 : kAir * (range.high - range.low);
    // Seconds, as usual in print, unless the interval is short.
    if (!channel_ && range.high - range.low >= kShort) largest = 1;
    const double extent = range.high - range.low;
    range.low = low_.value_or(is_phase() ? 0 : range.low - air);
    range.high = high_.value_or(is_phase() ? 1 : range.high + air);
    // One limit beyond all curves still is the end of the axis.
    if (low_ && !high_ && range.low >= range.high) range.high = range.low + extent;
    if (high_ && !low_ && range.low >= range.high) range.low = range.high - extent;
    const Channel channel = channel_.value_or(Channel{});
    Measure measure = measure_of(unit(channel, problem), largest, units);
    std::string symbol = render::print_symbol(channel);
    if (is_frequency()) measure = {1, "Hz"}, symbol = "$f$";
    if (is_phase()) measure = {1, ""}, symbol = phrase(lang_, "cam phase / turn");
    if (is_turns()) measure = {1, ""}, symbol = phrase(lang_, "turns of the cam");
    if (!unit_.name.empty()) measure = measure_in(unit_);
    if (!label_.empty()) symbol = label_;
    for (Panel& each : figure.panels) {
        each.x.keeps_unit = !unit_.name.empty();
        each.x.label = axis_label(symbol, measure.unit);
        if (range.high > range.low) each.x.from = range.low * measure.factor, each.x.to = range.high * measure.factor;
        for (Series& curve : each.series) curve.x = scaled(std::move(curve.x), measure.factor);
        for (auto& rule : each.rules)
            if (rule.vertical) rule.at *= measure.factor;
    }
}

}  // namespace beamcam::scenes
