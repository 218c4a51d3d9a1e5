#include "render/chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beamcam::render {

std::vector<Vec2> decimate(std::span<const double> t, std::span<const double> v,
                           const std::function<Vec2(double, double)>& to_pixels) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    std::vector<Vec2> out;
    const std::size_t n = std::min(t.size(), v.size());
    for (std::size_t i = 0; i < n;) {
        if (std::isnan(v[i])) {
            out.push_back({kNan, kNan});
            for (; i < n && std::isnan(v[i]); ++i) {
            }
            continue;
        }
        const double column = std::floor(to_pixels(t[i], v[i]).x);
        std::size_t low = i, high = i, last = i, end = i;
        for (; end < n && !std::isnan(v[end]) && std::floor(to_pixels(t[end], v[end]).x) == column; ++end) {
            if (v[end] < v[low]) low = end;
            if (v[end] > v[high]) high = end;
            last = end;
        }
        std::size_t keep[] = {i, std::min(low, high), std::max(low, high), last};
        std::size_t previous = n;
        for (std::size_t k : keep)
            if (k != previous) out.push_back(to_pixels(t[k], v[k])), previous = k;
        i = end;
    }
    return out;
}

Chart::Chart(ChartContent content, Box box, Box plot, double unit)
    : c_(std::move(content)), box_(box), plot_(plot), unit_(unit) {
    // Round ends first, then a mark at every multiple of the same step: the outermost lines carry labels.
    const int marks = std::clamp(static_cast<int>(plot.h / (45 * unit)), 2, 5);
    const double step = ticks(c_.value.low, c_.value.high, marks).step;
    c_.value = round_range(c_.value.low, c_.value.high, marks);
    value_ticks_ =
        ticks(c_.value.low, c_.value.high, static_cast<int>(std::lround((c_.value.high - c_.value.low) / step)) + 1);
    time_ticks_ = ticks(c_.time.low, c_.time.high, std::clamp(static_cast<int>(plot.w / (75 * unit)), 2, 7));
}

Vec2 Chart::to_pixels(double t, double v) const {
    return {plot_.x + plot_.w * (t - c_.time.low) / (c_.time.high - c_.time.low),
            plot_.bottom() - plot_.h * (v - c_.value.low) / (c_.value.high - c_.value.low)};
}

Box Chart::past_box() const { return {plot_.x - 8, plot_.y - 8, plot_.w + 16, plot_.h + 16}; }
int Chart::cursor_column(double t) const { return static_cast<int>(std::lround(to_pixels(t, c_.value.low).x)); }

std::vector<Vec2> Chart::curve() const {
    return decimate(c_.t, c_.v, [&](double t, double v) { return to_pixels(t, v); });
}

namespace {

void fill_under(Canvas& canvas, const std::vector<Vec2>& curve, double base, Color color) {
    std::size_t i = 0;
    while (i < curve.size()) {
        if (std::isnan(curve[i].x)) {
            ++i;
            continue;
        }
        std::size_t end = i;
        canvas.move_to({curve[i].x, base});
        for (; end < curve.size() && !std::isnan(curve[end].x); ++end) canvas.line_to(curve[end]);
        canvas.line_to({curve[end - 1].x, base});
        canvas.close();
        i = end;
    }
    canvas.fill(color);
}

}  // namespace

void Chart::draw_ground(Canvas& canvas, const Palette& p) const {
    const double u = unit_;
    const TextStyle heading{.size = 21 * u, .color = p.ink, .weight = Weight::semibold};
    const bool fits = canvas.measure(c_.words + c_.symbol, heading).w <= plot_.w - 84 * u;  // the reading stands beside
    canvas.text({plot_.x, box_.y + 26 * u}, fits ? c_.words + c_.symbol : c_.symbol, heading);
    const TextStyle label{.size = 17 * u, .color = p.muted, .align = Align::right};
    for (double v : value_ticks_.values) {
        const double y = std::round(to_pixels(c_.time.low, v).y) + 0.5;
        canvas.move_to({plot_.x, y});
        canvas.line_to({plot_.right(), y});
        canvas.stroke({p.grid, std::max(1.0, u), {}, Cap::butt});
        canvas.text({plot_.x - 12 * u, y + 6 * u}, fixed(v, value_ticks_.decimals), label);
    }
    const double axis = plot_.bottom() + 0.5;
    const Box unit = canvas.measure(c_.time_label, {.size = 17 * u});
    for (double t : time_ticks_.values) {
        const double x = std::round(to_pixels(t, 0).x) + 0.5;
        canvas.move_to({x, axis});
        canvas.line_to({x, axis + 6 * u});
        canvas.stroke({p.muted, std::max(1.0, u), {}, Cap::butt});
        const std::string text = fixed(t, time_ticks_.decimals);
        const double half = canvas.measure(text, {.size = 17 * u}).w / 2;
        if (x + half < plot_.right() + 8 * u - unit.w - 10 * u)  // the axis' name stands at the end of this line
            canvas.text({x, axis + 26 * u}, text, {.size = 17 * u, .color = p.muted, .align = Align::centre});
    }
    canvas.text({plot_.right() + 8 * u, axis + 26 * u}, c_.time_label, label);
    const std::vector<Vec2> points = curve();
    if (c_.filled) {
        fill_under(canvas, points, plot_.bottom(), c_.faint.faded(0.35));
    }
    canvas.polyline(points);
    canvas.stroke({c_.faint, 2 * u});
    for (const ChartDot& d : c_.dots) {
        canvas.circle(to_pixels(d.t, d.value), 2.2 * u);
        canvas.fill(c_.faint);
    }
    canvas.move_to({plot_.x, axis});
    canvas.line_to({plot_.right(), axis});
    canvas.stroke({p.muted, std::max(1.0, 1.3 * u), {}, Cap::butt});
}

Image Chart::past(const Fonts& fonts, const Palette& p) const {
    const Box box = past_box();
    Image image(static_cast<int>(box.w), static_cast<int>(box.h));
    Canvas canvas(image, fonts);
    const Vec2 shift{-box.x, -box.y};
    std::vector<Vec2> points = curve();
    for (Vec2& q : points) q += shift;
    if (c_.filled) fill_under(canvas, points, plot_.bottom() + shift.y, c_.color.faded(0.20));
    canvas.polyline(points);
    canvas.stroke({c_.color, 2.2 * unit_});
    for (const ChartDot& d : c_.dots) {
        canvas.circle(to_pixels(d.t, d.value) + shift, 2.6 * unit_);
        canvas.fill(d.color);
    }
    for (const ChartMark& m : c_.marks) {
        const double x = to_pixels(m.t, 0).x + shift.x, y = plot_.bottom() + shift.y;
        canvas.move_to({x, y - 1});
        canvas.line_to({x, y - 11 * unit_});
        canvas.stroke({p.contact, 1.8 * unit_, {}, Cap::butt});
    }
    return image;
}

void Chart::draw_cursor(Canvas& canvas, const Palette& p, double t, double v, const std::string& value) const {
    const double u = unit_, x = cursor_column(t) + 0.5;
    canvas.move_to({x, plot_.y - 6 * u});
    canvas.line_to({x, plot_.bottom()});
    canvas.stroke({p.ink, std::max(1.0, 1.4 * u), {}, Cap::butt});
    if (!std::isnan(v)) {
        canvas.circle({x, to_pixels(t, v).y}, 5.5 * u);
        canvas.fill_keeping_path(c_.color);
        canvas.stroke({p.paper, 1.6 * u});
    }
    if (!value.empty())
        canvas.text({plot_.right() + 8 * u, box_.y + 26 * u}, value,
                    {.size = 21 * u, .color = c_.color, .weight = Weight::medium, .align = Align::right});
}

}  // namespace beamcam::render
