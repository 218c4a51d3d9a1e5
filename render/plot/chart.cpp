#include "render/plot/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/plot/labels.hpp"
#include "render/plot/reduce.hpp"

namespace beamcam::render {
namespace {
constexpr double kAhead = 0.25;  // share of a moving window that shows what is to come
}  // namespace

// ---- the value axis ----------------------------------------------------------------------------

RoundAxis::RoundAxis(double low, double high, std::string unit, int most) : unit_(std::move(unit)) {
    const double span = high - low, largest = std::max(std::abs(low), std::abs(high));
    if (span > 0 && std::isfinite(span)) {
        // Values that agree in their first four digits are told from a round number among them.
        if (span < 1e-4 * largest) {
            const double digit = std::pow(10.0, std::ceil(std::log10(span)) + 1);
            offset_ = std::round((low + high) / 2 / digit) * digit;
        }
        const double most_told = offset_ != 0 ? std::max(std::abs(low - offset_), std::abs(high - offset_)) : largest;
        if (by_prefix())
            scale_ = prefix_for(most_told).factor;
        else if (most_told < 1e-2 || most_told >= 1e5)
            scale_ = std::pow(10.0, 3 * std::floor(std::log10(most_told * 1.0000001) / 3));
    }
    low = scaled(low), high = scaled(high);
    const double step = ticks(low, high, most).step;
    ends_ = round_range(low, high, most);
    marks_ = ticks(ends_.low, ends_.high, static_cast<int>(std::lround((ends_.high - ends_.low) / step)) + 1);
}

std::string RoundAxis::name(const std::string& symbol) const {
    std::string text = symbol;
    if (offset_ != 0) {
        const std::string value = fmt::format("{} {:.6g}", offset_ > 0 ? "−" : "+", std::abs(offset_));
        text =
            unit_.empty() ? fmt::format("{} {}", symbol, value) : fmt::format("({} {}\u2009{})", symbol, value, unit_);
    }
    std::string unit = unit_;
    if (scale_ != 1 && by_prefix())
        unit = prefix_for(scale_).symbol + unit_;
    else if (scale_ != 1)
        unit = pango_power_of_ten(static_cast<int>(std::lround(std::log10(scale_)))) +
               (unit_.empty() ? "" : "\u2009" + unit_);
    if (unit.empty()) return text;
    // A unit that is a quotient itself stands in brackets: dθ/dt / (rad/s).
    if (unit.find('/') != std::string::npos) unit = "(" + unit + ")";
    return fmt::format("{} / {}", text, unit);
}

void draw_levels(Canvas& canvas, const Palette& p, const RoundAxis& axis, const Box& plot, double u, double tick) {
    for (double mark : axis.marks().values) {
        const double at = std::round(plot.bottom() - axis.along(plot.h, axis.value(mark))) + 0.5;
        canvas.line({plot.x, at}, {plot.right(), at}, {p.grid, std::max(1.0, u), {}, Cap::butt});
        canvas.text({plot.x - 12 * u, at + 6.0 / 17 * tick}, fixed(mark, axis.marks().decimals),
                    {.size = tick, .color = p.muted, .align = HAlign::right});
    }
}

Chart::Chart(ChartContent content, Box box, Box plot, double unit, double tick)
    : c_(std::move(content)),
      box_(box),
      plot_(plot),
      unit_(unit),
      tick_(tick),
      axis_(c_.value.low, c_.value.high, c_.unit, std::clamp(static_cast<int>(plot.h / (45 * unit)), 2, 5)),
      digits_(std::clamp(2 - static_cast<int>(std::floor(std::log10(axis_.marks().step) + 1e-9)), 0, 6)) {}

double Chart::y(double v) const { return plot_.bottom() - axis_.along(plot_.h, v); }

// ---- the time axis -----------------------------------------------------------------------------

struct Chart::View {
    double from = 0, to = 1;  // at the plot's sides [s]
    double now = 0;           // [s]
    double x(const Box& plot, double t) const { return plot.x + plot.w * (t - from) / (to - from); }
};

Chart::View Chart::whole() const { return {c_.time.low, c_.time.high, c_.time.high}; }
Chart::View Chart::around(double t) const { return {t - (1 - kAhead) * *c_.window, t + kAhead * *c_.window, t}; }

Box Chart::past_box() const { return {plot_.x - 8, plot_.y - 8, plot_.w + 16, plot_.h + 16}; }
int Chart::cursor_column(const View& view, double t) const { return static_cast<int>(std::lround(view.x(plot_, t))); }
// Half of the widest stroke or dot, and a column of its edge.
int Chart::past_column(double t) const {
    return cursor_column(whole(), t) - static_cast<int>(std::ceil(3 * unit_)) - 1;
}

void Chart::draw_time_axis(Canvas& canvas, const Palette& p, const View& view) const {
    const double u = unit_, axis = plot_.bottom() + 0.5;
    const Ticks marks =
        ticks(view.from / c_.time_unit, view.to / c_.time_unit, std::clamp(static_cast<int>(plot_.w / (75 * u)), 2, 7));
    const Box unit = canvas.measure(c_.time_label, {.size = tick_});
    for (double at : marks.values) {
        if (windowed() && at < c_.time.low / c_.time_unit - 1e-9) continue;  // nothing was before the film
        double x = view.x(plot_, at * c_.time_unit);
        if (!windowed()) x = std::round(x) + 0.5;
        canvas.line({x, axis}, {x, axis + 6 * u}, {p.muted, std::max(1.0, u), {}, Cap::butt});
        const std::string text = fixed(at, marks.decimals);
        const double half = canvas.measure(text, {.size = tick_}).w / 2;
        if (x + half < plot_.right() + 8 * u - unit.w - 10 * u &&  // the axis' name stands at the end of this line
            (!windowed() || x - half > plot_.x - 20 * u))
            canvas.text({x, axis + 9 * u + tick_}, text, {.size = tick_, .color = p.muted, .align = HAlign::centre});
    }
    canvas.text({plot_.right() + 8 * u, axis + 9 * u + tick_}, c_.time_label,
                {.size = tick_, .color = p.muted, .align = HAlign::right});
}

// The readings stand beside it.
void Chart::draw_heading(Canvas& canvas, const Palette& p) const {
    const TextStyle heading{.size = 21 * unit_, .color = p.ink, .weight = Weight::semibold};
    const std::string symbol = axis_.name(c_.symbol);
    const bool fits = canvas.measure(c_.words + symbol, heading).w + reading_width(canvas, true) <= plot_.w;
    canvas.text({plot_.x, box_.y + 26 * unit_}, fits ? c_.words + symbol : symbol, heading);
}

// ---- curves ------------------------------------------------------------------------------------

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

// The curve over these times, from the last row before them on. What is to come goes on to the first row after them;
// what is past ends at their end.
std::vector<Vec2> points_within(const std::vector<double>& t, const std::vector<double>& v, Range times, bool past,
                                const std::function<Vec2(double, double)>& to_pixels) {
    auto first = std::ranges::lower_bound(t, times.low), last = std::ranges::upper_bound(t, times.high);
    const bool between = first != last || (first != t.begin() && last != t.end());
    if (first != t.begin()) --first;
    const auto at = static_cast<std::size_t>(first - t.begin());
    auto count = static_cast<std::size_t>(last - first);
    const bool more = last != t.end() && between;
    if (more && !past) ++count;
    std::vector<Vec2> points;
    points.reserve(count);
    for (std::size_t i = at; i < std::min(at + count, v.size()); ++i) points.push_back(to_pixels(t[i], v[i]));
    points = figure::column_extremes(points, 1);
    if (more && past && count > 0) {
        const std::size_t i = at + count - 1;
        const double share = (times.high - t[i]) / (t[i + 1] - t[i]), end = v[i] * (1 - share) + v[i + 1] * share;
        if (share > 0 && !std::isnan(end)) points.push_back(to_pixels(times.high, end));
    }
    return points;
}

}  // namespace

void Chart::draw_bands(Canvas& canvas, const View& view, Range rows, bool past, Vec2 shift) const {
    for (const Band& band : c_.bands) {
        const auto place = [&](double at, double v) { return Vec2{view.x(plot_, at), y(v)} + shift; };
        std::vector<Vec2> edge = points_within(c_.band_times, band.high, rows, past, place),
                          low = points_within(c_.band_times, band.low, rows, past, place);
        if (edge.size() < 2 || low.size() < 2) continue;
        edge.insert(edge.end(), low.rbegin(), low.rend());
        canvas.polyline(edge);
        canvas.close();
        canvas.fill(past ? band.color : band.color.faded(0.28));
    }
}

Pen Chart::pen(const Curve& curve, Color color, double width) const {
    return {color, width * unit_, dashes(curve.dash, unit_), curve.dash.empty() ? Cap::round : Cap::butt};
}

void Chart::draw_curves(Canvas& canvas, const View& view, Range rows, bool past, Vec2 shift) const {
    draw_bands(canvas, view, rows, past, shift);
    bool first_curve = true;
    for (const Curve& curve : c_.curves) {
        const std::vector<Vec2> points = points_within(curve.t, curve.v, rows, past, [&](double t, double v) {
            return Vec2{view.x(plot_, t), y(v)} + shift;
        });
        if (c_.filled && first_curve)
            fill_under(canvas, points, plot_.bottom() + shift.y,
                       past ? curve.color.faded(0.20) : curve.faint.faded(0.35));
        first_curve = false;
        if (past && !curve.pale_within.empty()) {
            draw_pale_past(canvas, view, rows, curve, shift);
            continue;
        }
        canvas.polyline(points);
        canvas.stroke(pen(curve, past ? curve.color : curve.faint, past ? 2.2 : 2));
    }
    for (const ChartDot& d : c_.dots) {
        if (d.t < rows.low || d.t > rows.high) continue;
        canvas.circle(Vec2{view.x(plot_, d.t), y(d.value)} + shift, (past ? 2.6 : 2.2) * unit_);
        canvas.fill(past ? d.color : d.faint);
    }
    if (!past) return;
    for (const ChartMark& mark : c_.marks) {
        if (mark.t < rows.low || mark.t > rows.high) continue;
        const Vec2 at = Vec2{view.x(plot_, mark.t), plot_.bottom()} + shift;
        // Lanes share what three ticks need.
        const double tall = mark.lanes == 1 ? 10 * unit_ : std::min(8.0, 30.0 / mark.lanes) * unit_;
        const double foot = at.y - 1 - tall * mark.lane;
        canvas.line({at.x, foot}, {at.x, foot - (mark.lanes == 1 ? tall : 0.85 * tall)},
                    {mark.color, 1.8 * unit_, {}, Cap::butt});
    }
}

// The pale pieces first: a piece begins at the row before its interval, and the strong ones hide that.
void Chart::draw_pale_past(Canvas& canvas, const View& view, Range rows, const Curve& curve, Vec2 shift) const {
    const auto piece = [&](double from, double to, Color color) {
        const Range times{std::max(from, rows.low), std::min(to, rows.high)};
        if (!(times.low < times.high)) return;
        canvas.polyline(points_within(curve.t, curve.v, times, true, [&](double t, double v) {
            return Vec2{view.x(plot_, t), y(v)} + shift;
        }));
        canvas.stroke(pen(curve, color, 2.2));
    };
    for (const Range& pale : curve.pale_within) piece(pale.low, pale.high, curve.pale);
    double from = rows.low;
    for (const Range& pale : curve.pale_within) piece(std::exchange(from, pale.high), pale.low, curve.color);
    piece(from, rows.high, curve.color);
}

void Chart::draw_ground(Canvas& canvas, const Palette& p) const {
    const double axis = plot_.bottom() + 0.5;
    draw_heading(canvas, p);
    if (c_.instead.empty())
        draw_levels(canvas, p, axis_, plot_, unit_, tick_);
    else
        canvas.text(plot_.centre() + Vec2{0, 6 * unit_}, c_.instead,
                    {.size = 19 * unit_, .color = p.muted, .align = HAlign::centre, .max_width = plot_.w});
    if (!windowed()) {
        draw_time_axis(canvas, p, whole());
        draw_curves(canvas, whole(), c_.time, false, {});
    }
    canvas.line({plot_.x, axis}, {plot_.right(), axis}, {p.muted, std::max(1.0, 1.3 * unit_), {}, Cap::butt});
}

Image Chart::past(const Fonts& fonts) const {
    if (windowed()) return {};
    const Box box = past_box();
    Image image(static_cast<int>(box.w), static_cast<int>(box.h));
    Canvas canvas(image, fonts);
    draw_curves(canvas, whole(), c_.time, true, {-box.x, -box.y});
    return image;
}

namespace {
constexpr double kBetweenReadings = 18;
TextStyle reading_style(double u, Color color) {
    return {.size = 21 * u, .color = color, .weight = Weight::medium, .align = HAlign::right};
}
}  // namespace

std::string Chart::told(double value) const {
    if (!c_.reading_unit.empty()) return quantity(value, c_.reading_unit.c_str());
    return fixed(axis_.scaled(value), digits_);
}

double Chart::widest_reading(Canvas& canvas, const TextStyle& style) const {
    if (!c_.reading_unit.empty()) return canvas.measure("00.0\u00A0m" + c_.reading_unit, style).w;
    return std::max(canvas.measure(fixed(axis_.ends().high, digits_), style).w,
                    canvas.measure(fixed(axis_.ends().low, digits_), style).w);
}

// Room for the widest value keeps the readings from dancing.
double Chart::reading_width(Canvas& canvas, bool named) const {
    const TextStyle style = reading_style(unit_, {});
    const double widest = widest_reading(canvas, style);
    double all = 0;
    for (const Curve& curve : c_.curves) {
        all += widest + kBetweenReadings * unit_;
        if (named && !curve.label.empty()) all += canvas.measure(curve.label + "\u2002", style).w;
    }
    return all;
}

// At the right end of the heading's line, the last curve's outermost; without their names where those have no room.
void Chart::draw_readings(Canvas& canvas, const Palette& p, std::span<const double> readings) const {
    const double u = unit_;
    const TextStyle heading{.size = 21 * u, .color = p.ink, .weight = Weight::semibold};
    const double room = plot_.w - canvas.measure(axis_.name(c_.symbol), heading).w;
    const bool named = reading_width(canvas, true) <= room;
    if (!named && readings.size() > 1 && reading_width(canvas, false) > room) return;
    double right = plot_.right() + 8 * u;
    for (std::size_t i = readings.size(); i-- > 0;) {
        const double v = readings[i];
        const std::string label = named && i < c_.curves.size() ? c_.curves[i].label : std::string();
        const TextStyle style = reading_style(u, readable(p, i < c_.curves.size() ? c_.curves[i].color : p.contact));
        const double widest = widest_reading(canvas, style);
        if (!std::isnan(v)) canvas.text({right, box_.y + 26 * u}, told(v), style);
        right -= widest;
        if (std::isnan(v) && !label.empty()) {  // a name that nothing follows would look forgotten
            TextStyle none = style;
            none.align = HAlign::left;
            canvas.text({right, box_.y + 26 * u}, "–", none);
        }
        if (!label.empty()) {
            canvas.text({right, box_.y + 26 * u}, label + "\u2002", style);
            right -= canvas.measure(label + "\u2002", style).w;
        }
        right -= kBetweenReadings * u;
    }
}

void Chart::draw_moving(Canvas& canvas, const Palette& p, double t, std::span<const double> readings) const {
    const double u = unit_;
    const View view = windowed() ? around(t) : whole();
    // Past and future meet at the cursor: each is drawn within its own part of the plot.
    const double cut = cursor_column(view, t) + 1, box = plot_.y - 8;
    double from = plot_.x;
    if (windowed()) {
        draw_time_axis(canvas, p, view);
        canvas.clip({cut, box, plot_.right() - cut, plot_.h + 9}, [&] {
            draw_curves(canvas, view, {view.from, view.to}, false, {});
        });
    } else {
        from = std::max(past_column(t), static_cast<int>(past_box().x));
    }
    // Columns before the first are drawn along: the curve comes from there.
    const double column = (view.to - view.from) / plot_.w, before = 4 * unit_ + 4;
    const Range rows{std::max(view.from, view.from + (from - plot_.x - before) * column), std::min(t, view.to)};
    canvas.clip({from, box, cut - from, windowed() ? plot_.h + 9 : plot_.h + 16},
                [&] { draw_curves(canvas, view, rows, true, {}); });
    const double x = cut - 0.5;
    canvas.line({x, plot_.y - 6 * u}, {x, plot_.bottom()}, {p.ink, std::max(1.0, 1.4 * u), {}, Cap::butt});
    for (std::size_t i = 0; i < readings.size(); ++i) {
        const double at = y(readings[i]);
        // An instant between the curves' rows may lie beyond their range: its number is told, a dot would lie.
        if (!(at > plot_.y - 8 * u && at < plot_.bottom() + 8 * u)) continue;
        canvas.circle({x, std::clamp(at, plot_.y - 4 * u, plot_.bottom() + 4 * u)}, 5.5 * u);
        canvas.fill_keeping_path(i < c_.curves.size() ? c_.curves[i].color : p.contact);
        canvas.stroke({p.paper, 1.6 * u});
    }
    draw_readings(canvas, p, readings);
}

}  // namespace beamcam::render
