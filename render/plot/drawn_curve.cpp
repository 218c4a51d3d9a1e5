#include "render/plot/drawn_curve.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "render/plot/reduce.hpp"

namespace beamcam::render::figure {
namespace {

constexpr double kGrainsPerPixel = 4;  // a pixel in grains: oscillations within it are not resolved

// Which markers stay visible: the last of those within `apart`.
std::vector<bool> not_covered(const std::vector<Vec2>& points, double apart) {
    std::vector<bool> seen(points.size(), false);
    std::set<std::pair<long, long>> taken;
    for (std::size_t i = points.size(); i-- > 0;)
        if (std::isfinite(points[i].x + points[i].y))
            seen[i] = taken.emplace(std::lround(points[i].x / apart), std::lround(points[i].y / apart)).second;
    return seen;
}

// The radius of markers without a line: smaller where they are at so many places that they would join.
double marker_radius(const std::vector<Vec2>& points, const Box& plot, double usual) {
    constexpr double kLeast = 0.5;  // of the usual one: below that, shapes are not told apart
    const auto places = std::ranges::count(not_covered(points, usual), true);
    return std::clamp(0.5 * plot.w / std::max<double>(1, static_cast<double>(places)), kLeast * usual, usual);
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

// Lines are reduced, so that a million points cost as little as a few thousand.
DrawnCurve::DrawnCurve(const Series& s, const Plot& plot, double grain) : series_(&s), points_(plot.points(s.x, s.y)) {
    for (std::size_t i = 0; plot.bar() && i < std::min(points_.size(), s.value.size()); ++i) {
        const std::optional<Color> color = plot.color_at(s.value[i]);
        if (!color) points_[i].x = std::nan("");
        colors_.push_back(color.value_or(Color{}));
    }
    if (!s.line || s.every_point) return;
    const std::vector<Envelope> fast = envelopes(points_, kGrainsPerPixel * grain);
    for (const Envelope& envelope : fast) bands_.push_back(outline(envelope, points_));
    points_ = reduce(without(fast, points_), grain);
}

void DrawnCurve::draw(const PlotStyle& style, Painter& on) const {
    const Series& s = *series_;
    if (!s.line) return;
    Pen pen = curve_pen(s, style);
    on.curve(points_, pen);
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
    if (finite == 1 && bands_.empty() && !s.every_point)
        draw_marker(on, style, look(s.look).marker, only, style.marker, pen.color, false);
}

void draw_sample(Painter& on, const PlotStyle& style, const Series& s, Vec2 from, Vec2 to) {
    const Pen pen = curve_pen(s, style);
    if (s.line) on.line(from, to, pen);
    if (s.every_point)
        draw_marker(on, style, look(s.look).marker, 0.5 * (from + to), style.marker, pen.color, s.look % 2 == 1);
}

void DrawnCurve::draw_markers(const Box& plot, const PlotStyle& style, Painter& on) const {
    const Series& s = *series_;
    if (!s.every_point) return;
    const bool colored = !colors_.empty();
    const std::vector<bool> seen =
        colored ? not_covered(points_, 0.15 * style.marker) : std::vector<bool>(points_.size(), true);
    const double radius = s.line ? style.marker : marker_radius(points_, plot, style.marker);
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const Vec2 p = points_[i];
        if (seen[i] && std::isfinite(p.x + p.y) && inside(plot, p, 0.5))
            draw_marker(on, style, look(s.look).marker, p, radius, colored ? colors_[i] : curve_pen(s, style).color,
                        !colored && s.look % 2 == 1);
    }
}

}  // namespace beamcam::render::figure
