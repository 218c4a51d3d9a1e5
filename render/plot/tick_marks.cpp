#include "render/plot/tick_marks.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {
namespace {

// The middle of a pixel, where a thin line is sharp; the slack makes rounding errors irrelevant.
double middle_of_pixel(double at) { return std::round(at + 1e-9) + 0.5; }

// The space of a number below an axis.
struct Number {
    double left = 0, right = 0;
    std::string* label = nullptr;
};

// The middle of the axis's name: at the right end if the last number leaves room there, otherwise before the last
// number, as DIN 461 recommends, in place of the number before it if necessary. Numbers that move, and single ones,
// give way to the name at the right end.
double place_name(const std::vector<Number>& numbers, double wide, double gap, double end, bool moves) {
    const double at_end = end - wide / 2, least = end - wide - gap;
    const std::size_t n = numbers.size();
    if (n == 0 || numbers.back().right < least) return at_end;
    for (std::size_t before = 2; !moves && before <= std::min<std::size_t>(n, 3); ++before) {
        const double from = numbers[n - before].right, to = numbers.back().left;
        if (to - from < wide + 2 * gap) continue;
        if (before == 3) numbers[n - 2].label->clear();
        return (from + to) / 2;
    }
    for (const Number& number : numbers)
        if (number.right >= least) number.label->clear();
    return at_end;
}

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
    const double width = std::max(1.0, u);
    TextStyle text{.size = size, .color = p.muted, .align = HAlign::centre};
    std::vector<Number> numbers;
    for (Tick& tick : ticks) {
        if (tick.label.empty()) continue;
        const double x = plot.x + plot.w * tick.at, at = moves ? x : middle_of_pixel(x);
        const double half = canvas.measure(tick.label, text).w / 2;
        numbers.push_back({at - half, at + half, &tick.label});
        if (moves && at - half <= plot.x - 20 * u) tick.label.clear();
    }
    const double name_at = place_name(numbers, canvas.measure(name, text).w, 10 * u, plot.right() + 8 * u, moves);
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
    canvas.text({name_at, above_axis.bottom() + 9 * u + size}, name, text);
}

void outline_on(Canvas& canvas, const Palette& palette, double unit) {
    canvas.outline = palette.outline();
    if (canvas.outline) canvas.casing = Casing{*canvas.outline, 3 * unit};
}

}  // namespace beamcam::render
