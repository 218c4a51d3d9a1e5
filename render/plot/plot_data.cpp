// The data of a plot: bands, curves, dots and events.
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "render/plot/plot.hpp"
#include "render/plot/reduce.hpp"

namespace beamcam::render::figure {
namespace {
constexpr double kPastLine = 2.2, kFutureLine = 2;  // of films: widths, and radii of dots [design px]
constexpr double kPastDot = 2.6, kFutureDot = 2.2;
constexpr double kTickInLane = 0.8;  // height of a tick in one of several lanes
constexpr double kLowestTick = 4;    // [design px]
}  // namespace

Color color_of(const Series& s) { return s.color.value_or(look(s.look).color); }

Pen curve_pen(const Series& s, const PlotStyle& style) {
    const double width = style.line * s.weight * (s.faded ? 0.7 : 1);
    Pen pen{color_of(s), width, s.solid ? std::vector<double>() : dashes(look(s.look).dash, width), Cap::butt};
    if (s.faded) pen.color = pale(pen.color);
    return pen;
}

std::vector<Vec2> Plot::points(const std::vector<double>& x, const std::vector<double>& y, const Interval& part) const {
    std::vector<Vec2> out;
    const std::size_t rows = std::min(x.size(), y.size());
    if (!style_->palette) {
        out.reserve(rows);
        for (std::size_t i = 0; i < rows; ++i) {
            const Vec2 p = at(x[i], y[i]);
            out.push_back({std::clamp(p.x, box_.x - 20 * box_.w, box_.right() + 20 * box_.w),
                           std::clamp(p.y, box_.y - 20 * box_.h, box_.bottom() + 20 * box_.h)});
        }
        return out;
    }
    auto first = std::ranges::lower_bound(x, part.from), last = std::ranges::upper_bound(x, part.to);
    const bool between = first != last || (first != x.begin() && last != x.end());
    if (first != x.begin()) --first;
    const auto begin = static_cast<std::size_t>(first - x.begin());
    auto count = static_cast<std::size_t>(last - first);
    const bool more = last != x.end() && between;
    if (more && !part.past) ++count;
    out.reserve(count);
    for (std::size_t i = begin; i < std::min(begin + count, rows); ++i) out.push_back(at(x[i], y[i]));
    out = column_extremes(out, 1);
    if (more && part.past && count > 0) {
        const std::size_t i = begin + count - 1;
        const double share = (part.to - x[i]) / (x[i + 1] - x[i]), end = y[i] * (1 - share) + y[i + 1] * share;
        if (share > 0 && !std::isnan(end)) out.push_back(at(part.to, end));
    }
    return out;
}

void Plot::draw_bands(Painter& on, const Interval& part) const {
    const auto fill = [&](std::vector<Vec2> edge, const std::vector<Vec2>& low, Color color) {
        if (edge.size() < 2 || low.size() < 2) return;
        edge.insert(edge.end(), low.rbegin(), low.rend());
        std::erase_if(edge, [](Vec2 p) { return !std::isfinite(p.x + p.y); });
        on.polyline(edge);
        on.close();
        on.fill(color);
    };
    for (const Band& b : panel_->bands)
        fill(points(b.x, b.high, part), points(b.x, b.low, part),
             part.past ? b.color.value_or(pale(look(b.look).color, 0.72)) : b.faint);
    for (const Series& s : panel_->series) {
        if (!s.filled) continue;
        const std::vector<Vec2> edge = points(s.x, s.y, part);
        std::vector<Vec2> low = edge;
        for (Vec2& p : low) p.y = box_.bottom() + shift_.y;
        fill(edge, low, part.past ? color_of(s).faded(0.20) : s.faint.faded(0.35));
    }
}

void Plot::draw_curve(Painter& on, const Series& s, const Interval& part) const {
    if (!(part.from < part.to)) return;
    on.curve(points(s.x, s.y, part),
             {part.past ? color_of(s) : s.faint, (part.past ? kPastLine : kFutureLine) * style_->unit,
              dashes(s.dash, style_->unit), s.dash.empty() ? Cap::round : Cap::butt});
}

void Plot::draw_dots_and_events(Painter& on, const Interval& part) const {
    const auto within = [&](double x) { return x >= part.from && x <= part.to; };
    const auto color = [&](const Dot& d) { return part.past ? d.color : d.faint; };
    const double u = style_->unit;
    const Dot* last = nullptr;  // in the path: translucent dots are filled together, or overlaps would be strong
    for (const Dot& d : panel_->dots) {
        if (!within(d.x)) continue;
        if (last && (color(d) != color(*last) || color(d).a == 1)) on.fill(color(*last));
        on.circle(at(d.x, d.y), (part.past ? kPastDot : kFutureDot) * u);
        last = &d;
    }
    if (last) on.fill(color(*last));
    if (!part.past) return;
    for (const EventTick& event : panel_->events) {
        if (!within(event.x)) continue;
        // Between axis and numbers, clear of the curves. Lanes that would be too low share one.
        const double x = along_x(event.x) + shift_.x, room = numbers_below() - on.cap_height(style_->numbers) - 3.5 * u;
        const bool apart = kTickInLane * room / event.lanes >= kLowestTick * u;
        const double lane = std::min(10 * u, apart ? room / event.lanes : room),
                     top = box_.bottom() + shift_.y + 1.5 * u + (apart ? lane * event.lane : 0);
        on.line({x, top}, {x, top + (event.lanes == 1 || !apart ? lane : kTickInLane * lane)},
                {event.color, 1.8 * u, {}, Cap::butt});
    }
}

// Intervals of the past, or above the curves their names: each once, in the first of its intervals that has room for it
// in the plot, as soon as all of the name is past.
void Plot::draw_spans(Painter& on, const Interval& part, bool names) const {
    TextStyle text = style_->tick_numbers();
    text.align = HAlign::centre;
    std::set<std::string> placed;
    for (const Span& span : panel_->spans) {
        const double left = along_x(span.from), right = along_x(span.to), wide = on.measure(span.label, text).w;
        const bool has_name =
            left >= box_.x && right <= box_.right() && wide < right - left && placed.insert(span.label).second;
        const double from = std::max(left, along_x(part.from)) + shift_.x,
                     to = std::min(right, along_x(part.to)) + shift_.x, middle = (left + right) / 2 + shift_.x;
        if (!part.past || !(from < to)) continue;
        text.halo = mix(style_->palette->paper, span.color.faded(1 / std::max(span.color.a, 1e-9)), span.color.a);
        if (!names) {
            on.rectangle({from, box_.y + shift_.y, to - from, box_.h});
            on.fill(span.color);
        } else if (has_name && middle + wide / 2 <= to)
            on.boxed_text({middle, box_.y + shift_.y + 0.9 * style_->numbers}, span.label, text);
    }
}

void Plot::draw_data(Painter& on, const Interval& part) const {
    draw_spans(on, part, false);
    draw_bands(on, part);
    draw_dots_and_events(on, part);  // below the curves, which many dots would hide
    for (const Series& curve : panel_->series) draw_curve(on, curve, part);
    draw_spans(on, part, true);
}

}  // namespace beamcam::render::figure
