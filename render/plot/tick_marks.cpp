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

double place_name(const Painter& painter, std::vector<Tick>& ticks, const Box& plot, const std::string& name,
                  const TextStyle& style, double unit, bool moves) {
    std::vector<Number> numbers;
    for (Tick& tick : ticks) {
        if (tick.label.empty()) continue;
        const double x = plot.x + plot.w * tick.at, at = moves ? x : middle_of_pixel(x);
        const double half = painter.measure(tick.label, style).w / 2;
        numbers.push_back({at - half, at + half, &tick.label});
        if (moves && at - half <= plot.x - 20 * unit) tick.label.clear();
    }
    const double wide = painter.measure(name, style).w, gap = 10 * unit, end = plot.right() + 8 * unit;
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

}  // namespace beamcam::render
