#include "render/plot/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "render/plot/narrow.hpp"
#include "render/plot/reduce.hpp"

namespace beamcam::render {
namespace {

constexpr double kPastLine = 2.2, kFutureLine = 2;  // widths, and radii of dots [design px]
constexpr double kPastDot = 2.6, kFutureDot = 2.2;
constexpr double kBetweenReadings = 18;

}  // namespace

Chart::Chart(ChartContent content, const Box& box, const Box& plot, const ChartStyle& style)
    : c_(std::move(content)),
      box_(box),
      plot_(plot),
      style_(style),
      axis_(chart_axis(c_.value.low, c_.value.high, c_.symbol, c_.unit,
                       std::clamp(static_cast<int>(plot.h / (45 * style.unit)), 2, 5))),
      digits_(std::clamp(2 - static_cast<int>(std::floor(std::log10(axis_.step()) + 1e-9)), 0, 6)) {}

// ---- the time axis -----------------------------------------------------------------------------

Range window_around(double t, double length) {
    constexpr double kAhead = 0.25;  // share that shows the future
    return {t - (1 - kAhead) * length, t + kAhead * length};
}

double Chart::x(const Range& view, double t) const {
    return plot_.x + plot_.w * (t - view.low) / (view.high - view.low);
}

Box Chart::past_box() const { return {plot_.x - 8, plot_.y - 8, plot_.w + 16, plot_.h + 16}; }
int Chart::cursor_column(const Range& view, double t) const { return static_cast<int>(std::lround(x(view, t))); }
// Half of the widest stroke or dot, and a column of its edge.
int Chart::past_column(double t) const {
    return cursor_column(whole(), t) - static_cast<int>(std::ceil(3 * style_.unit)) - 1;
}

void Chart::draw_time_axis(Canvas& canvas, const Range& view) const {
    // As many numbers as are apart.
    Ticks marks;
    const double low = view.low / c_.time_unit, high = view.high / c_.time_unit;
    for (int most = std::clamp(static_cast<int>(plot_.w / (75 * style_.unit)), 2, 7); most >= 2; --most) {
        marks = ticks(low, high, most);
        const double wide = canvas.measure(fixed(high, marks.decimals), {.size = style_.numbers}).w + 14 * style_.unit;
        if (marks.step / (high - low) * plot_.w >= wide) break;
    }
    std::vector<Tick> numbers;
    for (const double at : marks.values)
        if (!windowed() || at >= c_.time.low / c_.time_unit - 1e-9)  // no numbers before the film
            numbers.push_back({(at * c_.time_unit - view.low) / (view.high - view.low), fixed(at, marks.decimals)});
    draw_numbers_below(canvas, style_, plot_, std::move(numbers), c_.time_label, false, windowed());
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

}  // namespace

Vec2 Chart::place(const Segment& segment, double t, double v) const {
    return Vec2{x(segment.view, t), y(v)} + segment.shift;
}

// From the last row before the segment on. The future goes on to the first row after it; the past ends at its end.
std::vector<Vec2> Chart::points(const std::vector<double>& t, const std::vector<double>& v,
                                const Segment& segment) const {
    const Range& times = segment.rows;
    auto first = std::ranges::lower_bound(t, times.low), last = std::ranges::upper_bound(t, times.high);
    const bool between = first != last || (first != t.begin() && last != t.end());
    if (first != t.begin()) --first;
    const auto at = static_cast<std::size_t>(first - t.begin());
    auto count = static_cast<std::size_t>(last - first);
    const bool more = last != t.end() && between;
    if (more && !segment.past) ++count;
    std::vector<Vec2> points;
    points.reserve(count);
    for (std::size_t i = at; i < std::min(at + count, v.size()); ++i) points.push_back(place(segment, t[i], v[i]));
    points = column_extremes(points, 1);
    if (more && segment.past && count > 0) {
        const std::size_t i = at + count - 1;
        const double share = (times.high - t[i]) / (t[i + 1] - t[i]), end = v[i] * (1 - share) + v[i + 1] * share;
        if (share > 0 && !std::isnan(end)) points.push_back(place(segment, times.high, end));
    }
    return points;
}

void Chart::draw_bands(Canvas& canvas, const Segment& segment) const {
    for (const ChartBand& band : c_.bands) {
        std::vector<Vec2> edge = points(c_.band_times, band.high, segment),
                          low = points(c_.band_times, band.low, segment);
        if (edge.size() < 2 || low.size() < 2) continue;
        edge.insert(edge.end(), low.rbegin(), low.rend());
        canvas.polyline(edge);
        canvas.close();
        canvas.fill(segment.past ? band.color : band.color.faded(0.28));
    }
}

void Chart::draw_curves(Canvas& canvas, const Segment& segment) const {
    draw_bands(canvas, segment);
    if (c_.filled && !c_.curves.empty()) {
        const ChartCurve& first = c_.curves.front();
        fill_under(canvas, points(first.t, first.v, segment), plot_.bottom() + segment.shift.y,
                   segment.past ? first.color.faded(0.20) : first.faint.faded(0.35));
    }
    for (const ChartCurve& curve : c_.curves) draw_line(canvas, curve, segment);
    draw_dots_and_marks(canvas, segment);
}

void Chart::draw_line(Canvas& canvas, const ChartCurve& curve, const Segment& segment) const {
    const auto piece = [&](const Range& rows, Color color) {
        const double width = (segment.past ? kPastLine : kFutureLine) * style_.unit;
        const std::vector<Vec2> all = points(curve.t, curve.v, {segment.view, rows, segment.past, segment.shift});
        if (curve.dash.empty()) {
            canvas.polyline(all);
            return canvas.stroke({color, width});
        }
        const std::vector<double> dash = dashes(curve.dash, style_.unit);
        const DashedCurve pieces = without_dashes_in_spikes(all, std::accumulate(dash.begin(), dash.end(), 0.0));
        canvas.polyline(pieces.dashed);
        canvas.stroke({color, width, dash, Cap::butt});
        if (pieces.solid.empty()) return;
        canvas.polyline(pieces.solid);
        canvas.stroke({color, width});
    };
    if (!segment.past || curve.pale_within.empty())
        return piece(segment.rows, segment.past ? curve.color : curve.faint);
    // Pale pieces first: a piece begins at the row before its interval, which the strong pieces cover.
    const auto part = [&](double from, double to, Color color) {
        const Range times{std::max(from, segment.rows.low), std::min(to, segment.rows.high)};
        if (times.low < times.high) piece(times, color);
    };
    for (const Range& pale : curve.pale_within) part(pale.low, pale.high, curve.pale);
    double from = segment.rows.low;
    for (const Range& pale : curve.pale_within) part(std::exchange(from, pale.high), pale.low, curve.color);
    part(from, segment.rows.high, curve.color);
}

void Chart::draw_dots_and_marks(Canvas& canvas, const Segment& segment) const {
    const auto within = [&](double t) { return t >= segment.rows.low && t <= segment.rows.high; };
    const auto color = [&](const ChartDot& d) { return segment.past ? d.color : d.faint; };
    const ChartDot* last = nullptr;  // in the path: translucent dots are filled together, or overlaps would be strong
    for (const ChartDot& d : c_.dots) {
        if (!within(d.t)) continue;
        if (last && (color(d) != color(*last) || color(d).a == 1)) canvas.fill(color(*last));
        canvas.circle(place(segment, d.t, d.value), (segment.past ? kPastDot : kFutureDot) * style_.unit);
        last = &d;
    }
    if (last) canvas.fill(color(*last));
    if (!segment.past) return;
    for (const ChartMark& mark : c_.marks) {
        if (!within(mark.t)) continue;
        const Vec2 at = Vec2{x(segment.view, mark.t), plot_.bottom()} + segment.shift;
        // All lanes share the height of two ticks, so that they stay below the curves.
        const double tall = mark.lanes == 1 ? 10 * style_.unit : std::min(8.0, 20.0 / mark.lanes) * style_.unit;
        const double foot = at.y - 1 - tall * mark.lane;
        canvas.line({at.x, foot}, {at.x, foot - (mark.lanes == 1 ? tall : 0.85 * tall)},
                    {mark.color, 1.8 * style_.unit, {}, Cap::butt});
    }
}

void Chart::draw_background(Canvas& canvas) const {
    const auto& [p, u, size] = style_;
    const double axis = plot_.bottom() + 0.5;
    draw_heading(canvas);
    if (c_.instead.empty())
        draw_levels(canvas, style_, axis_, plot_);
    else
        canvas.text(plot_.centre() + Vec2{0, 6 * u}, c_.instead,
                    {.size = 19 * u, .color = p.muted, .align = HAlign::centre, .max_width = plot_.w});
    if (!windowed()) {
        draw_time_axis(canvas, whole());
        draw_curves(canvas, {whole(), c_.time, false});
    }
    canvas.line({plot_.x, axis}, {plot_.right(), axis}, {p.muted, std::max(1.0, 1.3 * u), {}, Cap::butt});
}

Image Chart::past(const Fonts& fonts) const {
    if (windowed()) return {};
    const Box box = past_box();
    Image image(static_cast<int>(box.w), static_cast<int>(box.h));
    Canvas canvas(image, fonts);
    outline_on(canvas, style_.palette, style_.unit);
    draw_curves(canvas, {whole(), c_.time, true, {-box.x, -box.y}});
    return image;
}

void Chart::draw_moving(Canvas& canvas, double t, std::span<const double> readings) const {
    const auto& [p, u, size] = style_;
    const Range view = windowed() ? window_around(t, *c_.window) : whole();
    // Past and future meet at the cursor: each is drawn within its own part of the plot.
    const double cut = cursor_column(view, t) + 1, box = plot_.y - 8;
    double from = plot_.x;
    if (windowed()) {
        draw_time_axis(canvas, view);
        canvas.clip({cut, box, plot_.right() - cut, plot_.h + 9}, [&] { draw_curves(canvas, {view, view, false}); });
    } else {
        from = std::max(past_column(t), static_cast<int>(past_box().x));
    }
    // Some columns before the first are drawn, too: the curve starts there.
    const double column = (view.high - view.low) / plot_.w, before = 4 * u + 4;
    const Range rows{std::max(view.low, view.low + (from - plot_.x - before) * column), std::min(t, view.high)};
    canvas.clip({from, box, cut - from, windowed() ? plot_.h + 9 : plot_.h + 16}, [&] {
        draw_curves(canvas, {view, rows, true});
    });
    const double x = cut - 0.5;
    canvas.line({x, plot_.y - 6 * u}, {x, plot_.bottom()}, {p.ink, std::max(1.0, 1.4 * u), {}, Cap::butt});
    for (std::size_t i = 0; i < readings.size(); ++i) {
        const double at = y(readings[i]);
        // A value between the rows may lie beyond their range: its number is shown, but a dot would be misplaced.
        if (!(at > plot_.y - 8 * u && at < plot_.bottom() + 8 * u)) continue;
        canvas.circle({x, std::clamp(at, plot_.y - 4 * u, plot_.bottom() + 4 * u)}, 5.5 * u);
        canvas.fill_keeping_path(i < c_.curves.size() ? c_.curves[i].color : p.contact);
        canvas.stroke({p.paper, 1.6 * u});
    }
    draw_readings(canvas, readings);
}

// ---- the heading's line ------------------------------------------------------------------------

TextStyle Chart::heading_style() const {
    return {.size = style_.heading(), .color = style_.palette.ink, .weight = Weight::semibold};
}
TextStyle Chart::reading_style(Color color) const {
    return {.size = style_.heading(), .color = color, .weight = Weight::medium, .align = HAlign::right};
}

// The readings are beside it.
void Chart::draw_heading(Canvas& canvas) const {
    const std::string name = axis_.name();
    const double room = plot_.w - reading_width(canvas, true, true);
    canvas.text({plot_.x, box_.y + 26 * style_.unit},
                first_that_fits(canvas, {c_.words + name, c_.short_words + name, name}, heading_style(), room),
                heading_style());
}

std::string Chart::reading_text(double value) const {
    if (c_.reading_unit.empty()) return fixed(axis_.tick_value(value), digits_);
    if (value == 0) return quantity(0, prefix_for(axis_.high()), c_.reading_unit.c_str());
    return reading(value, c_.reading_unit.c_str());
}

double Chart::widest_reading(Canvas& canvas) const {
    const TextStyle style = reading_style({});
    if (!c_.reading_unit.empty())
        return canvas.measure(std::string("00.0\u00A0") + prefix_for(axis_.high()).symbol + c_.reading_unit, style).w;
    return std::max(canvas.measure(fixed(axis_.ends().high, digits_), style).w,
                    canvas.measure(fixed(axis_.ends().low, digits_), style).w);
}

// The name before a reading, or alone without its colon.
static std::string name_of(const ChartCurve& curve, bool with_reading) {
    if (curve.label.empty()) return {};
    return with_reading ? curve.label + "\u2002" : curve.label.substr(0, curve.label.rfind(':'));
}

// Room for the widest value, so that the readings do not move.
double Chart::reading_width(Canvas& canvas, bool names, bool values) const {
    const double widest = values ? widest_reading(canvas) : 0;
    double all = 0;
    for (const ChartCurve& curve : c_.curves) {
        all += widest + kBetweenReadings * style_.unit;
        if (names) all += canvas.measure(name_of(curve, values), reading_style({})).w;
    }
    return all;
}

// At the right end, that of the last curve outermost; without names, or names alone, if there is no room for both.
void Chart::draw_readings(Canvas& canvas, std::span<const double> readings) const {
    const auto& [p, u, size] = style_;
    const double room = plot_.w - canvas.measure(axis_.name(), heading_style()).w, baseline = box_.y + 26 * u;
    const bool named = reading_width(canvas, true, true) <= room;
    const bool names_only = !named && c_.names_first && reading_width(canvas, true, false) <= room;
    if (!named && !names_only && readings.size() > 1 && reading_width(canvas, false, true) > room) return;
    const double widest = widest_reading(canvas);
    double right = plot_.right() + 8 * u;
    for (std::size_t i = readings.size(); i-- > 0;) {
        const double v = readings[i];
        const std::string label =
            (named || names_only) && i < c_.curves.size() ? name_of(c_.curves[i], named) : std::string();
        const TextStyle style = reading_style(readable(p, i < c_.curves.size() ? c_.curves[i].color : p.contact));
        if (names_only) {
            canvas.text({right, baseline}, label, style);
            right -= canvas.measure(label, style).w;
        } else if (label.empty()) {
            if (!std::isnan(v)) canvas.text({right, baseline}, reading_text(v), style);
            right -= widest;
        } else {
            right -= widest;
            TextStyle beside = style;
            beside.align = HAlign::left;
            // A name without a value would look like an error.
            const std::string number = std::isnan(v) ? "–" : reading_text(v);
            right -= std::max(0.0, canvas.measure(number, beside).w - widest);
            canvas.text({right, baseline}, number, beside);
            canvas.text({right, baseline}, label, style);
            right -= canvas.measure(label, style).w;
        }
        right -= kBetweenReadings * u;
    }
}

}  // namespace beamcam::render
