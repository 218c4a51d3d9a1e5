#include "render/plot/drawn_curve.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "render/plot/reduce.hpp"

namespace beamcam::render::figure {
namespace {

constexpr double kGrainsPerPixel = 4;         // a pixel in grains: oscillations within it are not resolved
constexpr double kTonesOfAnOscillation = 24;  // of a curve that is coloured by a value

// Which markers stay visible: the last of those within `apart`.
std::vector<bool> not_covered(const std::vector<Vec2>& points, double apart) {
    std::vector<bool> seen(points.size(), false);
    std::set<std::pair<long, long>> taken;
    for (std::size_t i = points.size(); i-- > 0;)
        if (std::isfinite(points[i].x + points[i].y))
            seen[i] = taken.emplace(std::lround(points[i].x / apart), std::lround(points[i].y / apart)).second;
    return seen;
}

// The radius of markers without a line: smaller where they are so many that they would join.
double marker_radius(const std::vector<Vec2>& points, const Box& plot, double usual) {
    constexpr double kLeast = 0.55;  // of the usual one: below that, shapes are not told apart
    const auto seen = std::ranges::count_if(points, [&](const Vec2 p) { return inside(plot, p, 0.5); });
    return std::clamp(0.5 * plot.w / std::max<double>(1, static_cast<double>(seen)), kLeast * usual, usual);
}

// The items with these indices; `broken` for kBreak.
template <class Item>
std::vector<Item> taken(const std::vector<std::size_t>& indices, const std::vector<Item>& from, Item broken) {
    std::vector<Item> all;
    all.reserve(indices.size());
    for (const std::size_t i : indices) all.push_back(i == kBreak ? broken : from[i]);
    return all;
}

}  // namespace

void draw_marker(Painter& on, const PlotStyle& style, Marker shape, Vec2 p, double r, Color color, bool hollow) {
    const auto polygon = [&](std::initializer_list<Vec2> corners) {
        bool first = true;
        for (const Vec2 c : corners) {
            first ? on.move_to(p + c * r) : on.line_to(p + c * r);
            first = false;
        }
        on.close();
    };
    switch (shape) {
        case Marker::circle:
            on.circle(p, r);
            break;
        case Marker::square:
            polygon({{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}});
            break;
        case Marker::triangle:
            polygon({{0, -1.2}, {1.1, 0.8}, {-1.1, 0.8}});
            break;
        case Marker::diamond:
            polygon({{0, -1.25}, {1.25, 0}, {0, 1.25}, {-1.25, 0}});
            break;
        case Marker::down:
            polygon({{0, 1.2}, {1.1, -0.8}, {-1.1, -0.8}});
            break;
        case Marker::cross:
            on.move_to(p + Vec2{-r, -r});
            on.line_to(p + Vec2{r, r});
            on.move_to(p + Vec2{-r, r});
            on.line_to(p + Vec2{r, -r});
            return on.stroke({color, style.line, {}, Cap::butt});
    }
    if (!hollow) return on.fill(color);
    on.fill_keeping_path(kWhite);
    on.stroke({color, 0.8 * style.line, {}, Cap::butt});
}

DrawnCurve::DrawnCurve(const Series& s, const Plot& plot, double grain)
    : series_(&s), points_(plot.points(s.x, s.y, s.right)) {
    const std::size_t count = points_.size();
    for (std::size_t i = 0; i < std::min(count, s.value.size()); ++i) value_.push_back(plot.color_share(s.value[i]));
    if (s.line && !s.every_point) lighten(grain);
}

// Reduces the points, so that a million cost as little as a few thousand.
void DrawnCurve::lighten(double grain) {
    const Vec2 broken{std::nan(""), std::nan("")};
    const std::vector<Envelope> fast = envelopes(points_, kGrainsPerPixel * grain);
    const std::size_t count = points_.size();
    if (!value_.empty()) {
        if (!fast.empty()) thin_out_tones(without(fast, count, true));
        return;
    }
    for (const Envelope& envelope : fast) bands_.push_back(outline(envelope, points_));
    line_ = reduce(taken(without(fast, count, false), points_, broken), grain);
    points_ = fast.empty() ? line_ : reduce(taken(without(fast, count, true), points_, broken), grain);
}

// Keeps these points of a curve that is coloured by a value, and adds points where the colour changes.
void DrawnCurve::thin_out_tones(const std::vector<std::size_t>& kept) {
    const std::vector<double> value = taken(kept, std::exchange(value_, {}), 0.0);
    const std::vector<Vec2> points = taken(kept, std::exchange(points_, {}), Vec2{});
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double rise = i > 0 ? value[i] - value[i - 1] : 0;
        const int tones =
            std::isfinite(rise) ? std::max(1, static_cast<int>(std::ceil(std::abs(rise) * kTonesOfAnOscillation))) : 1;
        for (int k = 1; k < tones; ++k) {
            const double share = double(k) / tones;
            points_.push_back(points[i - 1] + (points[i] - points[i - 1]) * share);
            value_.push_back(value[i - 1] + rise * share);
        }
        points_.push_back(points[i]);
        value_.push_back(value[i]);
    }
}

void DrawnCurve::draw(const PlotStyle& style, PageCanvas& on) const {
    if (!series_->line) return;
    value_.empty() ? draw_line(style, on) : draw_tones(style, on);
}

void DrawnCurve::draw_tones(const PlotStyle& style, PageCanvas& on) const {
    const Series& s = *series_;
    Pen pen = curve_pen(s, style);
    // One stroke for each colour; 48 steps look continuous.
    constexpr int kColorSteps = 48;
    const auto step = [&](std::size_t i) {
        const double v = value_[i];
        return std::isfinite(v) ? static_cast<int>(std::lround(std::clamp(v, 0.0, 1.0) * kColorSteps)) : -1;
    };
    pen.dash.clear();
    const double apart = 2 * on.grain();
    for (std::size_t i = 0; i + 1 < points_.size();) {
        const int tone = step(i);
        std::vector<Vec2> piece{points_[i]};
        std::size_t k = i + 1;
        for (; k < points_.size(); ++k) {
            const bool ends = step(k) != tone;
            if (ends || !(norm(points_[k] - piece.back()) < apart)) piece.push_back(points_[k]);
            if (ends) break;
        }
        if (tone >= 0) {
            pen.color = map_color(static_cast<double>(tone) / kColorSteps);
            pen.cap = Cap::round;
            on.polyline(piece);
            on.stroke(pen);
        }
        i = k;
    }
}

void DrawnCurve::draw_line(const PlotStyle& style, Painter& on) const {
    const Series& s = *series_;
    Pen pen = curve_pen(s, style);
    on.curve(s.every_point ? points_ : line_, pen);
    pen.dash.clear();
    for (const std::vector<Vec2>& band : bands_) {
        on.polyline(band);
        on.close();
        on.fill_keeping_path(pen.color);
        on.stroke(pen);
    }
    // A single point draws no line and gets a marker.
    std::size_t finite = 0;
    Vec2 only;
    for (const Vec2 p : points_)
        if (std::isfinite(p.x + p.y)) ++finite, only = p;
    if (finite == 1 && !s.every_point)
        draw_marker(on, style, look(s.look).marker, only, style.marker, pen.color, false);
}

void draw_sample(Painter& on, const PlotStyle& style, const Series& s, Vec2 from, Vec2 to) {
    const Pen pen = curve_pen(s, style);
    if (s.line && s.value.empty()) on.line(from, to, pen);
    if (s.every_point)
        draw_marker(on, style, look(s.look).marker, 0.5 * (from + to), style.marker, pen.color, s.look % 2 == 1);
}

void DrawnCurve::draw_markers(const Box& plot, const PlotStyle& style, Painter& on) const {
    const Series& s = *series_;
    if (!s.every_point) return;
    const bool toned = !value_.empty();
    const std::vector<bool> seen =
        toned ? not_covered(points_, 0.15 * style.marker) : std::vector<bool>(points_.size(), true);
    const double radius = s.line ? style.marker : marker_radius(points_, plot, style.marker);
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const Vec2 p = points_[i];
        if (!seen[i] || !std::isfinite(p.x + p.y) || !inside(plot, p, 0.5)) continue;
        if (!toned)
            draw_marker(on, style, look(s.look).marker, p, radius, curve_pen(s, style).color, s.look % 2 == 1);
        else if (std::isfinite(value_[i]))
            draw_marker(on, style, look(s.look).marker, p, style.marker, map_color(value_[i]), false);
    }
}

}  // namespace beamcam::render::figure
