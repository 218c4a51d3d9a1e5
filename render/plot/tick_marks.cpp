#include "render/plot/tick_marks.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {
namespace {

// The middle of a pixel, where a thin line is sharp; the slack makes rounding errors irrelevant.
double middle_of_pixel(double at) { return std::round(at + 1e-9) + 0.5; }

}  // namespace

void draw_ticks(Painter& painter, std::span<const Tick> ticks, const Box& plot, Side side, const TickStyle& style) {
    const bool below = side == Side::bottom || side == Side::top, first = side == Side::left || side == Side::top;
    for (const Tick& t : ticks) {
        double along = below ? plot.x + t.at * plot.w : plot.bottom() - t.at * plot.h;
        if (style.whole_pixels) along = middle_of_pixel(along);
        const Vec2 at =
            below ? Vec2{along, first ? plot.y : plot.bottom()} : Vec2{first ? plot.x : plot.right(), along};
        const double in = (first ? 1 : -1) * (t.major ? style.major : style.minor);
        if (t.line && in != 0) painter.line(at, at + (below ? Vec2{0, in} : Vec2{in, 0}), style.pen);
        if (style.numbers && !t.label.empty()) painter.text(at + style.beside, t.label, *style.numbers);
    }
}

AxisMap chart_axis(double low, double high, const std::string& symbol, const std::string& unit, int most) {
    const Axis axis{.label = unit.empty() ? symbol : symbol + " / " + unit,
                    .tight = true,
                    .round_ends = true,
                    .short_numbers = true};
    return {axis, {true, low, high}, most, "chart"};
}

void draw_levels(Canvas& canvas, const ChartStyle& style, const AxisMap& axis, const Box& plot) {
    const auto& [p, u, size] = style;
    draw_ticks(canvas, axis.ticks(), plot, Side::left,
               {.pen = {p.grid, std::max(1.0, u), {}, Cap::butt},
                .major = plot.w,
                .numbers = TextStyle{.size = size, .color = p.muted, .align = HAlign::right},
                .beside = {-12 * u, 6.0 / 17 * size},
                .whole_pixels = true});
}

void draw_numbers_below(Canvas& canvas, const ChartStyle& style, const Box& plot, std::vector<Tick> ticks,
                        const std::string& name, bool across, bool moves) {
    const auto& [p, u, size] = style;
    const double right = plot.right() + 8 * u, width = std::max(1.0, u);
    TextStyle text{.size = size, .color = p.muted, .align = HAlign::centre};
    const double room = right - canvas.measure(name, text).w - 10 * u;
    for (Tick& tick : ticks) {
        const double x = plot.x + plot.w * tick.at, half = canvas.measure(tick.label, text).w / 2;
        const double at = moves ? x : middle_of_pixel(x);
        if (at + half >= room || (moves && at - half <= plot.x - 20 * u)) tick.label.clear();
    }
    if (across)
        draw_ticks(canvas, ticks, plot, Side::top,
                   {.pen = {p.grid, width, {}, Cap::butt}, .major = plot.h, .whole_pixels = !moves});
    const Box above_axis{plot.x, plot.y, plot.w, plot.h + 0.5};
    draw_ticks(canvas, ticks, above_axis, Side::bottom,
               {.pen = {p.muted, width, {}, Cap::butt},
                .major = across ? 0 : -6 * u,
                .numbers = text,
                .beside = {0, 9 * u + size},
                .whole_pixels = !moves});
    text.align = HAlign::right;
    canvas.text({right, above_axis.bottom() + 9 * u + size}, name, text);
}

void outline_on(Canvas& canvas, const Palette& palette, double unit) {
    canvas.outline = palette.outline();
    if (canvas.outline) canvas.casing = Casing{*canvas.outline, 3 * unit};
}

}  // namespace beamcam::render
