#include "render/plot/chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "render/plot/ticks.hpp"

namespace beamcam::render {
namespace {

constexpr double kBetweenReadings = 18;                                 // [design px]
constexpr double kBetweenRows = 1, kLowestRow = 1.5, kAbovePeak = 0.5;  // in sizes of the numbers
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void draw_all(Canvas& canvas, const std::vector<figure::Plot>& rows, const figure::Interval& part) {
    for (const figure::Plot& row : rows) row.draw_data(canvas, part);
}

// The row of a curve.
const figure::Plot& row_of(const std::vector<figure::Plot>& rows, std::size_t curve) {
    return rows[std::min(curve, rows.size() - 1)];
}

}  // namespace

void ChartContent::set_time(const Range& time, double unit, std::string label) {
    panel.x = {.label = std::move(label),
               .from = time.low,
               .to = time.high,
               .unit = unit,
               .first_number = time.low / unit - 1e-9};  // none before the film
}

void ChartContent::set_values(const Range& values, const std::string& symbol, const std::string& unit) {
    panel.y = {.label = unit.empty() ? symbol : symbol + " / " + unit,
               .from = values.low,
               .to = values.high,
               .round_ends = true,
               .short_numbers = true};
}

Chart::Chart(ChartContent content, const Box& box, const Box& plot, const figure::PlotStyle& style, const Fonts& fonts)
    : c_(std::move(content)), box_(box), area_(plot), style_(style), palette_(*style.palette) {
    make_rows(fonts);
    double finest = 0;  // of the reading
    for (const figure::Plot& row : plots_) finest = std::max(finest, row.y().step() / 50);
    digits_ = std::clamp(-static_cast<int>(std::floor(std::log10(finest) + 1e-9)), 0, 6);
    if (!windowed() && !c_.past_only) draw_whole_past(fonts);
}

// Rows that would be too low are one, whose curves are not filled. All have the same axes.
void Chart::make_rows(const Fonts& fonts) {
    const auto wanted = static_cast<double>(c_.rows);
    const double gap = std::round(kBetweenRows * style_.numbers), high = std::floor((area_.h + gap) / wanted - gap);
    const std::size_t rows = high < kLowestRow * style_.numbers ? 1 : c_.rows;
    for (std::size_t k = 0; k < rows; ++k) {
        figure::Panel& row = panels_.emplace_back(c_.panel);
        if (rows < c_.rows)
            for (figure::Series& curve : row.series) curve.filled = false;
        if (rows == 1) break;
        row.series.assign(c_.panel.series.begin() + std::ptrdiff_t(rows), c_.panel.series.end());
        row.series.push_back(c_.panel.series[k]);
        std::erase_if(row.events, [k](const figure::EventTick& at) { return at.lane != static_cast<int>(k); });
        for (figure::EventTick& at : row.events) at.lane = 0, at.lanes = 1;
    }
    Image none(1, 1);
    for (std::size_t k = 0; k < rows; ++k) {
        const double bottom = area_.bottom() - static_cast<double>(rows - 1 - k) * (high + gap);
        plots_.emplace_back(panels_[k], style_, "chart", k + 1 == rows)
            .place(Canvas(none, fonts), rows == 1 ? area_ : Box{area_.x, bottom - high, area_.w, high});
    }
}

Range window_around(double t, double length) {
    constexpr double kAhead = 0.25;  // share that shows the future
    return {t - (1 - kAhead) * length, t + kAhead * length};
}

int Chart::cursor_column(const Range& view, double t) const {
    const Box& plot = area_;
    return static_cast<int>(std::lround(plot.x + plot.w * (t - view.low) / (view.high - view.low)));
}
// Half of the widest stroke or dot, and a column of its edge.
int Chart::past_column(double t) const {
    return cursor_column(time(), t) - static_cast<int>(std::ceil(3 * style_.unit)) - 1;
}

// ---- background, past, moving part ---------------------------------------------------------------------

void Chart::draw_background(Canvas& canvas) const {
    draw_heading(canvas);
    if (!c_.instead.empty())
        canvas.text(area_.centre() + Vec2{0, 6 * style_.unit}, c_.instead,
                    {.size = 19 * style_.unit, .color = palette_.muted, .align = HAlign::centre, .max_width = area_.w});
    for (const figure::Plot& plot : plots_)
        if (c_.instead.empty()) plot.draw_y_axis(canvas);
    if (!windowed()) plots_.back().draw_x_axis(canvas);
    if (!windowed() && !c_.past_only) draw_all(canvas, plots_, whole(false));
    for (const figure::Plot& plot : plots_) plot.draw_frame(canvas);
}

void Chart::draw_whole_past(const Fonts& fonts) {
    const Box box = past_box();
    past_ = Image(static_cast<int>(box.w), static_cast<int>(box.h));
    Canvas canvas(past_, fonts);
    canvas.halo_of_all = palette_.halo_of_all();
    std::vector<figure::Plot> moved = plots_;
    for (figure::Plot& plot : moved) plot.move_data({-box.x, -box.y});
    draw_all(canvas, moved, whole(true));
}

void Chart::draw_moving(Canvas& canvas, double t, std::span<const double> readings, std::span<const Vec2> peaks) const {
    Range view = windowed() ? window_around(t, *c_.window) : time();
    // A window moves within the time of the chart.
    const double shift = std::max(std::min(0.0, time().high - view.high), time().low - view.low);
    if (windowed()) view = {view.low + shift, view.high + shift};
    // Past and future meet at the cursor: each is drawn within its own part of the plot.
    const double cut = cursor_column(view, t) + 1, top = area_.y - kAround;
    if (!windowed() && t < time().low) return;
    const bool over = !windowed() && t > time().high;  // everything is past
    double from = area_.x;
    if (past_.width > 0 && !canvas.is_vector()) {
        const Box box = past_box();
        from = std::max<double>(over ? std::lround(area_.right() + 1) : past_column(t), box.x);
        canvas.image_part(past_, static_cast<int>(box.x), static_cast<int>(box.y), {0, 0, from - box.x, box.h});
        if (over) return draw_peaks(canvas, plots_, {&from, 1}, peaks);
    }
    std::vector<figure::Plot> moved;  // the window
    if (windowed()) moved = plots_;
    for (figure::Plot& plot : moved) plot.show_x(canvas, view.low, view.high);
    const std::vector<figure::Plot>& shown = windowed() ? moved : plots_;
    if (windowed()) {
        shown.back().draw_x_axis(canvas);
        canvas.clip({cut, top, area_.right() - cut, area_.h + 9}, [&] {
            draw_all(canvas, shown, {view.low, view.high, false});
        });
    }
    // Some columns before the first are drawn, too: the curve starts there.
    const double column = (view.high - view.low) / area_.w, before = 4 * style_.unit + 4;
    const figure::Interval past{std::max(view.low, view.low + (from - area_.x - before) * column),
                                std::min(t, view.high), true};
    canvas.clip({from, top, cut - from, past_box().h}, [&] { draw_all(canvas, shown, past); });
    if (!over) draw_cursor(canvas, cut - 0.5, area_, readings);
    draw_peaks(canvas, shown, {&cut, 1}, peaks);
    draw_readings(canvas, readings);
}

void Chart::draw_rows(Canvas& canvas, std::span<const double> times, std::span<const double> readings,
                      std::span<const Vec2> peaks) const {
    std::vector<double> cuts;  // the ends of the past [px]
    for (std::size_t k = 0; k < plots_.size(); ++k) {
        const double t = plots_.size() == times.size() ? times[k] : std::ranges::max(times),
                     end = std::min(t, time().high);
        cuts.push_back(cursor_column(time(), end) + 1 + (t > time().high ? kAround : 0));
        if (t < time().low) continue;
        const Box& row = plots_[k].box();
        canvas.clip({area_.x, row.y - kAround, cuts[k] - area_.x, row.h + 2 * kAround}, [&] {
            plots_[k].draw_data(canvas, {time().low, end, true});
        });
        if (!(t > time().high))
            draw_cursor(canvas, cuts[k] - 0.5, row, plots_.size() > 1 ? readings.subspan(k, 1) : readings, k);
    }
    draw_peaks(canvas, plots_, cuts, peaks);
    draw_readings(canvas, readings);
}

void Chart::draw_cursor(Canvas& canvas, double x, const Box& along, std::span<const double> readings,
                        std::size_t first) const {
    const double u = style_.unit;
    canvas.line({x, along.y - 6 * u}, {x, along.bottom()}, {palette_.ink, std::max(1.0, 1.4 * u), {}, Cap::butt});
    for (std::size_t i = 0; i < readings.size(); ++i) {
        const figure::Plot& row = row_of(plots_, first + i);
        const Box& plot = row.box();
        const double at = row.along_y(readings[i]);
        // A value between the rows may lie beyond their range: its number is shown, but a dot would be misplaced.
        if (!(at > plot.y - 8 * u && at < plot.bottom() + 8 * u)) continue;
        canvas.circle({x, std::clamp(at, plot.y - 4 * u, plot.bottom() + 4 * u)}, 5.5 * u);
        canvas.fill_keeping_path(reading_color(first + i));
        canvas.stroke({palette_.paper, 1.6 * u});
    }
}

// Centred above its own peak, if that does not read zero and the number has room: between the axis and the cursor,
// below the heading or the row above, with nothing higher of the curve under it, in a row of its own.
void Chart::draw_peaks(Canvas& canvas, const std::vector<figure::Plot>& rows, std::span<const double> cursors,
                       std::span<const Vec2> peaks) const {
    if (c_.rows != rows.size()) return;  // rows of several motions are one
    const double size = style_.numbers;
    for (std::size_t i = 0; i < peaks.size(); ++i) {
        if (!(plots_[0].y().tick_value(peaks[i].y) >= 0.5 * ten_to(-digits_))) continue;
        const figure::Plot& row = row_of(rows, i);
        const Vec2 at = row.at(peaks[i].x, peaks[i].y);
        const double end = std::min(cursors[std::min(i, cursors.size() - 1)] - 8 * style_.unit, area_.right());
        const TextStyle style{.size = size,
                              .color = readable(palette_, reading_color(i)),
                              .weight = Weight::medium,
                              .align = HAlign::centre,
                              .halo = palette_.paper};
        const std::string text = reading_text(peaks[i].y);
        const double half = canvas.measure(text, style).w / 2;
        bool fits = at.x - half >= area_.x && at.x + half <= end && at.y - kAbovePeak * size >= row.box().y;
        const figure::Series& curve = c_.panel.series[i];
        for (std::size_t k = 0; k < curve.x.size() && fits; ++k)
            fits = !(curve.y[k] > peaks[i].y && std::abs(row.at(curve.x[k], 0).x - at.x) < half);
        if (fits) canvas.text(at - Vec2{0, 0.45 * size}, text, style);
    }
}

// ---- the heading's line ------------------------------------------------------------------------

TextStyle Chart::heading_style() const {
    return {.size = style_.letters, .color = palette_.ink, .weight = Weight::semibold};
}
TextStyle Chart::reading_style(Color color) const {
    return {.size = style_.letters, .color = color, .weight = Weight::medium, .align = HAlign::right, .tabular = true};
}

Color Chart::reading_color(std::size_t curve) const {
    return curve < c_.panel.series.size() ? color_of(c_.panel.series[curve]) : palette_.contact;
}

// The readings are beside it.
void Chart::draw_heading(Canvas& canvas) const {
    canvas.text({area_.x, box_.y + 26 * style_.unit}, heading_text(canvas), heading_style());
}

std::string Chart::heading_text(Canvas& canvas) const {
    const std::string name = plots_[0].y().name();
    const double room = area_.w - reading_width(canvas, true, true);
    return first_that_fits(canvas, {c_.words + name, c_.short_words + name, name}, heading_style(), room);
}

// In the unit of the axis, with the decimals that its ticks ask for. On an axis without negative values only zero and
// rounding read zero: a smaller value than the last decimal shows is "<0.01".
std::string Chart::reading_text(double value) const {
    constexpr double kRounding = 1e-9;  // of the axis
    const std::string unit = plots_[0].y().unit();
    const double number = plots_[0].y().tick_value(value), least = ten_to(-digits_);
    const bool small = c_.values().low == 0 && value > kRounding * c_.values().high && number < 0.5 * least;
    return (small ? "<" + fixed(least, digits_) : fixed(number, digits_)) +
           (unit.empty() || unit == "°" ? unit : "\u00A0" + unit);
}

double Chart::widest_reading(Canvas& canvas) const {
    const TextStyle style = reading_style({});
    double widest = 0;
    for (const double value : {c_.values().low, c_.values().high, 1e-6 * c_.values().high})
        widest = std::max(widest, canvas.measure(reading_text(value), style).w);
    return widest;
}

// The name before a reading, or alone without its colon.
static std::string name_of(const figure::Series& curve, bool with_reading) {
    if (curve.label.empty()) return {};
    return with_reading ? curve.label + "\u2002" : curve.label.substr(0, curve.label.rfind(':'));
}

// Room for the widest value, so that the readings do not move.
double Chart::reading_width(Canvas& canvas, bool names, bool values) const {
    const double widest = values ? widest_reading(canvas) : 0;
    double all = 0;
    for (const figure::Series& curve : c_.panel.series) {
        all += widest + kBetweenReadings * style_.unit;
        if (names) all += canvas.measure(name_of(curve, values), reading_style({})).w;
    }
    return all;
}

// At the right end, that of the last curve outermost; without names, or names alone, if there is no room for both.
void Chart::draw_readings(Canvas& canvas, std::span<const double> readings) const {
    const double u = style_.unit;
    const double room = area_.w - canvas.measure(plots_[0].y().name(), heading_style()).w, baseline = box_.y + 26 * u;
    const bool named = reading_width(canvas, true, true) <= room;
    const bool names_only = !named && c_.names_first && reading_width(canvas, true, false) <= room;
    if (!named && !names_only && readings.size() > 1 && reading_width(canvas, false, true) > room) return;
    const double widest = widest_reading(canvas);
    double right = area_.right() + 8 * u;
    for (std::size_t i = readings.size(); i-- > 0;) {
        const bool has_name = (named || names_only) && i < c_.panel.series.size();
        const std::string label = has_name ? name_of(c_.panel.series[i], named) : std::string();
        TextStyle style = reading_style(readable(palette_, reading_color(i)));
        // A name without a value would look like an error.
        const bool none = std::isnan(readings[i]);
        const std::string number = names_only || (none && label.empty()) ? "" : none ? "–" : reading_text(readings[i]);
        const double wide = canvas.measure(number, style).w;
        if (!names_only && !label.empty()) style.align = HAlign::left, right -= std::max(widest, wide);
        canvas.text({right, baseline}, number, style);
        if (!names_only && label.empty()) right -= std::max(widest, wide);
        style.align = HAlign::right;
        canvas.text({right, baseline}, label, style);
        right -= canvas.measure(label, style).w + kBetweenReadings * u;
    }
}

}  // namespace beamcam::render
