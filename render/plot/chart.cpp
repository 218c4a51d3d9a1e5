#include "render/plot/chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace beamcam::render {
namespace {

constexpr double kBetweenReadings = 18;  // [design px]

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
    : c_(std::move(content)), box_(box), style_(style), palette_(*style.palette), plot_(c_.panel, style_, "chart") {
    Image none(1, 1);
    plot_.place(Canvas(none, fonts), plot);
    digits_ = std::clamp(2 - static_cast<int>(std::floor(std::log10(plot_.y().step()) + 1e-9)), 0, 6);
    if (!windowed()) draw_whole_past(fonts);
}

Range window_around(double t, double length) {
    constexpr double kAhead = 0.25;  // share that shows the future
    return {t - (1 - kAhead) * length, t + kAhead * length};
}

int Chart::cursor_column(const Range& view, double t) const {
    const Box& plot = plot_.box();
    return static_cast<int>(std::lround(plot.x + plot.w * (t - view.low) / (view.high - view.low)));
}
// Half of the widest stroke or dot, and a column of its edge.
int Chart::past_column(double t) const {
    return cursor_column(time(), t) - static_cast<int>(std::ceil(3 * style_.unit)) - 1;
}

// ---- background, past, moving part ---------------------------------------------------------------------

void Chart::draw_background(Canvas& canvas) const {
    const Box& plot = plot_.box();
    draw_heading(canvas);
    if (c_.instead.empty())
        plot_.draw_y_axis(canvas);
    else
        canvas.text(plot.centre() + Vec2{0, 6 * style_.unit}, c_.instead,
                    {.size = 19 * style_.unit, .color = palette_.muted, .align = HAlign::centre, .max_width = plot.w});
    if (!windowed()) {
        plot_.draw_x_axis(canvas);
        if (!c_.past_only) plot_.draw_data(canvas, whole(false));
    }
    plot_.draw_frame(canvas);
}

void Chart::draw_whole_past(const Fonts& fonts) {
    const Box box = past_box();
    past_ = Image(static_cast<int>(box.w), static_cast<int>(box.h));
    Canvas canvas(past_, fonts);
    canvas.halo_of_all = palette_.halo_of_all();
    figure::Plot moved = plot_;
    moved.move_data({-box.x, -box.y});
    moved.draw_data(canvas, whole(true));
}

void Chart::draw_moving(Canvas& canvas, double t, std::span<const double> readings) const {
    const Box& plot = plot_.box();
    const Range view = windowed() ? window_around(t, *c_.window) : time();
    // Past and future meet at the cursor: each is drawn within its own part of the plot.
    const double cut = cursor_column(view, t) + 1, top = plot.y - kAround;
    if (!windowed() && t < time().low) return;
    const bool over = !windowed() && t > time().high;  // everything is past
    double from = plot.x;
    if (!windowed() && !canvas.is_vector()) {
        const Box box = past_box();
        from = std::max<double>(over ? std::lround(plot.right() + 1) : past_column(t), box.x);
        canvas.image_part(past_, static_cast<int>(box.x), static_cast<int>(box.y), {0, 0, from - box.x, box.h});
        if (over) return;
    }
    std::optional<figure::Plot> shown;  // the window
    if (windowed()) {
        shown = plot_;
        shown->show_x(canvas, view.low, view.high);
        shown->draw_x_axis(canvas);
        canvas.clip({cut, top, plot.right() - cut, plot.h + 9}, [&] {
            shown->draw_data(canvas, {view.low, view.high, false});
        });
    }
    // Some columns before the first are drawn, too: the curve starts there.
    const double column = (view.high - view.low) / plot.w, before = 4 * style_.unit + 4;
    const figure::Interval past{std::max(view.low, view.low + (from - plot.x - before) * column),
                                std::min(t, view.high), true};
    canvas.clip({from, top, cut - from, past_box().h}, [&] { (shown ? *shown : plot_).draw_data(canvas, past); });
    if (!over) draw_cursor(canvas, cut - 0.5, readings);
}

void Chart::draw_cursor(Canvas& canvas, double x, std::span<const double> readings) const {
    const Box& plot = plot_.box();
    const double u = style_.unit;
    canvas.line({x, plot.y - 6 * u}, {x, plot.bottom()}, {palette_.ink, std::max(1.0, 1.4 * u), {}, Cap::butt});
    for (std::size_t i = 0; i < readings.size(); ++i) {
        const double at = plot_.along_y(readings[i]);
        // A value between the rows may lie beyond their range: its number is shown, but a dot would be misplaced.
        if (!(at > plot.y - 8 * u && at < plot.bottom() + 8 * u)) continue;
        canvas.circle({x, std::clamp(at, plot.y - 4 * u, plot.bottom() + 4 * u)}, 5.5 * u);
        canvas.fill_keeping_path(reading_color(i));
        canvas.stroke({palette_.paper, 1.6 * u});
    }
    draw_readings(canvas, readings);
}

// ---- the heading's line ------------------------------------------------------------------------

TextStyle Chart::heading_style() const {
    return {.size = style_.letters, .color = palette_.ink, .weight = Weight::semibold};
}
TextStyle Chart::reading_style(Color color) const {
    return {.size = style_.letters, .color = color, .weight = Weight::medium, .align = HAlign::right};
}

Color Chart::reading_color(std::size_t curve) const {
    return curve < c_.panel.series.size() ? color_of(c_.panel.series[curve]) : palette_.contact;
}

// The readings are beside it.
void Chart::draw_heading(Canvas& canvas) const {
    const std::string name = plot_.y().name();
    const double room = plot_.box().w - reading_width(canvas, true, true);
    canvas.text({plot_.box().x, box_.y + 26 * style_.unit},
                first_that_fits(canvas, {c_.words + name, c_.short_words + name, name}, heading_style(), room),
                heading_style());
}

// In the unit of the axis, with the decimals that its ticks ask for.
std::string Chart::reading_text(double value) const {
    const std::string unit = plot_.y().unit();
    return fixed(plot_.y().tick_value(value), digits_) + (unit.empty() || unit == "°" ? unit : "\u00A0" + unit);
}

double Chart::widest_reading(Canvas& canvas) const {
    const TextStyle style = reading_style({});
    return std::max(canvas.measure(reading_text(c_.values().high), style).w,
                    canvas.measure(reading_text(c_.values().low), style).w);
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
    const double room = plot_.box().w - canvas.measure(plot_.y().name(), heading_style()).w, baseline = box_.y + 26 * u;
    const bool named = reading_width(canvas, true, true) <= room;
    const bool names_only = !named && c_.names_first && reading_width(canvas, true, false) <= room;
    if (!named && !names_only && readings.size() > 1 && reading_width(canvas, false, true) > room) return;
    const double widest = widest_reading(canvas);
    double right = plot_.box().right() + 8 * u;
    for (std::size_t i = readings.size(); i-- > 0;) {
        const bool blank = c_.blank_zeros && readings[i] == 0;
        const double v = blank ? std::numeric_limits<double>::quiet_NaN() : readings[i];
        const bool has_name = (named || names_only) && i < c_.panel.series.size();
        const std::string label = has_name ? name_of(c_.panel.series[i], named) : std::string();
        const TextStyle style = reading_style(readable(palette_, reading_color(i)));
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
