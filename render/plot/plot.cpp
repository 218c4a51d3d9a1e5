#include "render/plot/plot.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render::figure {
namespace {

struct Extents {
    Extent x, y, color;
};
Extents extents_of(const Panel& panel) {
    Extents all;
    const auto add = [&](std::span<const double> x, std::span<const double> y) {
        all.x.add(x, panel.x.scale);
        all.y.add(y, panel.y.scale);
    };
    for (const Series& s : panel.series) {
        const auto shows = [](double v, Scale scale) { return std::isfinite(v) && (scale == Scale::linear || v > 0); };
        // Only points with two valid numbers.
        for (std::size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i)
            if (shows(s.x[i], panel.x.scale) && shows(s.y[i], panel.y.scale)) add({&s.x[i], 1}, {&s.y[i], 1});
        all.color.add(s.value, panel.color_bar ? panel.color_bar->scale : Scale::linear);
    }
    for (const Band& b : panel.bands) add(b.x, b.low), add(b.x, b.high);
    for (const Cells& c : panel.cells) add(c.x, c.y);
    for (const Cloud& c : panel.clouds) add(c.x, c.y);
    for (const Mark& m : panel.marks) add({&m.x, 1}, {&m.y, 1});
    return all;
}

// ---- ticks and their numbers -------------------------------------------------------------------------

struct TickStyle {
    Pen pen;
    double major = 0, minor = 0;            // lengths into the plot; negative: away from it; 0: no line
    std::optional<TextStyle> numbers = {};  // none: no numbers
    Vec2 beside = {};                       // from the tick's place on the side to its number
    bool whole_pixels = false;              // in the middles of pixels, where thin lines are sharp
};

// The middle of a pixel, where a thin line is sharp; the slack makes rounding errors irrelevant.
double middle_of_pixel(double at) { return std::round(at + 1e-9) + 0.5; }

void draw_ticks(Painter& painter, std::span<const Tick> ticks, const Box& plot, Side side, const TickStyle& style) {
    const bool below = side == Side::bottom || side == Side::top, first = side == Side::left || side == Side::top;
    for (const Tick& t : ticks) {
        double along = below ? plot.x + t.at * plot.w : plot.bottom() - t.at * plot.h;
        if (style.whole_pixels) along = middle_of_pixel(along);
        const Vec2 at =
            below ? Vec2{along, first ? plot.y : plot.bottom()} : Vec2{first ? plot.x : plot.right(), along};
        const double in = (first ? 1 : -1) * (t.major ? style.major : style.minor);
        if (in != 0) painter.line(at, at + (below ? Vec2{0, in} : Vec2{in, 0}), style.pen);
        if (style.numbers && !t.label.empty()) painter.text(at + style.beside, t.label, *style.numbers);
    }
}

// The middle of the name of an axis at the right end of the row of its numbers below the plot, where numbers give way;
// between the last two numbers if fewer than two would remain and it has room there; left of all if none would remain.
// Nor do numbers remain that would touch the one before.
double place_name(const Painter& painter, std::vector<Tick>& ticks, const Box& plot, const std::string& name,
                  const TextStyle& style, double unit, bool moves) {
    const double wide = painter.measure(name, style).w, gap = 14 * unit, end = plot.right() + 8 * unit;
    double kept = -1e9, first = 1e9;   // the ends of numbers
    Range between{0, 0};               // the last two numbers
    std::vector<std::string*> beside;  // the numbers that the name at the right end replaces
    int before = 0;                    // numbers left of the name there
    for (Tick& tick : ticks) {
        if (tick.label.empty()) continue;
        const double at = plot.x + plot.w * tick.at, half = painter.measure(tick.label, style).w / 2;
        first = std::min(first, at - half);
        if ((moves && at - half <= plot.x - 20 * unit) || at - half < kept + 4 * unit) {
            tick.label.clear();
            continue;
        }
        between = {kept, at - half};
        kept = at + half;
        if (kept < end - wide - gap)
            ++before;
        else
            beside.push_back(&tick.label);
    }
    if (before < 2 && !moves && between.low > 0 && between.high - between.low >= wide + gap)
        return (between.low + between.high) / 2;
    if (before == 0) return first - gap - wide / 2;
    for (std::string* number : beside) number->clear();
    return end - wide / 2;
}

}  // namespace

// ---- the choice of ticks ------------------------------------------------------------------------------

void Plot::fit_x(const Painter& on, const Axis& axis, const Extent& data) {
    const std::string what = what_ + ", horizontal axis";
    const TextStyle numbers = style_->tick_numbers();
    if (!style_->palette) {
        x_.emplace(axis, data, std::clamp(static_cast<int>(width_ / (4.2 * style_->numbers)), 3, 9), what);
        return;
    }
    // As many numbers as leave room between each other.
    const auto most_that_fit = static_cast<int>(width_ / ((axis.grid ? 85 : 75) * style_->unit));
    for (int most = std::clamp(most_that_fit, 2, axis.grid ? 6 : 7); most >= 2; --most) {
        x_.emplace(axis, data, most, what);
        const auto [low, high] = x_->ends();
        const auto width = [&](double end) { return on.measure(fixed(end, decimals_of(x_->step())), numbers).w; };
        const double wide = std::max(width(low), width(high)) + 14 * style_->unit;
        if (x_->step() / (high - low) * width_ >= wide) break;
    }
}

void Plot::fit(const Painter& on, double width, double height) {
    width_ = width, height_ = height;
    auto [ex, ey, eb] = extents_of(*panel_);
    fit_x(on, panel_->x, ex);
    const int up = style_->palette
                       ? std::clamp(static_cast<int>(height / (40 * style_->unit)), 3, panel_->y.grid ? 6 : 5)
                       : std::clamp(static_cast<int>(height / (2.3 * style_->numbers)), 3, 8);
    y_.emplace(panel_->y, ey, up, what_ + ", vertical axis");
    bar_.reset();
    if (const auto& bar = panel_->color_bar)
        bar_.emplace(Axis{.label = bar->label, .scale = bar->scale, .from = bar->from, .to = bar->to, .tight = true},
                     eb, up, what_ + ", colour bar");
}

void Plot::show_x(const Painter& on, double from, double to) {
    Axis axis = panel_->x;
    axis.from = from, axis.to = to;
    moves_ = true;
    fit_x(on, axis, {});
}

Vec2 Plot::at(double x, double y) const { return Vec2{along_x(x), along_y(y)} + shift_; }

// ---- axes and frame -------------------------------------------------------------------------------------

double Plot::drop(const Painter& on) const {
    if (!lowest_ || !panel_->x.numbered) return 0;
    double out = 0;
    for (const Tick& below : x_->ticks()) {
        const double out_of_plot = 0.5 * on.measure(below.label, style_->tick_numbers()).w - width_ * below.at;
        if (below.label.empty() || out_of_plot < 0.6 * style_->gap) continue;
        for (const Tick& beside : y_->ticks())
            if (!beside.label.empty())
                out = std::max(out, 0.35 * style_->numbers + 0.5 * on.cap_height(style_->numbers) - style_->gap -
                                        beside.at * height_);
    }
    return out;
}

void Plot::draw_page_ticks(Painter& on, const AxisMap& axis, const Box& box, Side side, bool labelled, double major,
                           double minor) const {
    TickStyle style{.pen = {kInk, style_->frame, {}, Cap::butt}, .major = major, .minor = minor};
    if (labelled) style.numbers = style_->tick_numbers();
    if (labelled && side == Side::bottom) {
        style.numbers->align = HAlign::centre, style.numbers->valign = VAlign::top;
        style.beside = {0, style_->gap + drop(on)};
    } else if (labelled) {
        style.numbers->align = side == Side::left ? HAlign::right : HAlign::left;
        style.numbers->valign = VAlign::middle;
        style.beside = {side == Side::left ? -style_->gap : style_->gap, 0};
    }
    draw_ticks(on, axis.ticks(), box, side, style);
}

void Plot::draw_x_axis(Painter& on) const {
    if (!style_->palette) {
        draw_page_ticks(on, *x_, box_, Side::bottom, lowest_, style_->tick, style_->minor_tick);
        return draw_page_ticks(on, *x_, box_, Side::top, false, style_->tick, style_->minor_tick);
    }
    const double u = style_->unit, below = numbers_below();
    const bool grid = panel_->x.grid;
    TextStyle text = style_->tick_numbers();
    text.align = HAlign::centre;
    std::vector<Tick> ticks = x_->ticks();
    const double name_at = place_name(on, ticks, box_, x_->name(), text, u, moves_);
    if (grid)
        draw_ticks(
            on, ticks, box_, Side::top,
            {.pen = {style_->palette->grid, style_->frame, {}, Cap::butt}, .major = box_.h, .whole_pixels = !moves_});
    const Box above_axis{box_.x, box_.y, box_.w, box_.h + 0.5};
    draw_ticks(on, ticks, above_axis, Side::bottom,
               {.pen = {style_->palette->muted, style_->frame, {}, Cap::butt},
                .major = grid ? 0 : -6 * u,
                .numbers = text,
                .beside = {0, below},
                .whole_pixels = !moves_});
    on.text({name_at, above_axis.bottom() + below}, x_->name(), text);
}

void Plot::draw_y_axis(Painter& on) const {
    if (!style_->palette) {
        draw_page_ticks(on, *y_, box_, Side::left, true, style_->tick, style_->minor_tick);
        return draw_page_ticks(on, *y_, box_, Side::right, false, style_->tick, style_->minor_tick);
    }
    TextStyle text = style_->tick_numbers();
    text.align = HAlign::right;
    // Where numbers would touch each other, the first and the last remain, or the last alone.
    std::vector<Tick> ticks = y_->ticks();
    std::erase_if(ticks, [](const Tick& tick) { return !tick.major; });
    const double apart = y_->step() / (y_->ends().high - y_->ends().low) * box_.h, least = 1.1 * style_->numbers;
    const bool few = !ticks.empty() && (ticks.back().at - ticks.front().at) * box_.h < 0.9 * style_->numbers;
    for (std::size_t i = few ? 0 : 1; apart < least && i + 1 < ticks.size(); ++i) ticks[i].label.clear();
    draw_ticks(on, ticks, box_, Side::left,
               {.pen = {style_->palette->grid, style_->frame, {}, Cap::butt},
                .major = box_.w,
                .numbers = text,
                .beside = {-12 * style_->unit, 6.0 / 17 * style_->numbers},
                .whole_pixels = true});
}

void Plot::draw_frame(Painter& on) const {
    if (style_->palette) {
        const double axis = box_.bottom() + 0.5;
        return on.line({box_.x, axis}, {box_.right(), axis},
                       {style_->palette->muted, std::max(1.0, 1.3 * style_->unit), {}, Cap::butt});
    }
    on.rectangle(box_);
    on.stroke({kInk, style_->frame, {}, Cap::butt});
}

}  // namespace beamcam::render::figure
