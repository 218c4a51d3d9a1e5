#include "render/plot/chart_axes.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {
namespace {

// The middle of a pixel, where a thin line is sharp; the slack makes rounding errors irrelevant.
double middle_of_pixel(double at) { return std::round(at + 1e-9) + 0.5; }

}  // namespace

AxisMap chart_axis(double low, double high, const std::string& symbol, const std::string& unit, int most) {
    const Axis axis{.label = unit.empty() ? symbol : symbol + " / " + unit,
                    .tight = true,
                    .round_ends = true,
                    .short_numbers = true};
    return {axis, {true, low, high}, most, "chart"};
}

void draw_levels(Canvas& canvas, const ChartStyle& style, const AxisMap& axis, const Box& plot) {
    const auto& [p, u, size] = style;
    for (const Tick& tick : axis.ticks()) {
        if (!tick.major) continue;
        const double y = middle_of_pixel(plot.bottom() - plot.h * tick.at);
        canvas.line({plot.x, y}, {plot.right(), y}, {p.grid, std::max(1.0, u), {}, Cap::butt});
        canvas.text({plot.x - 12 * u, y + 6.0 / 17 * size}, tick.label,
                    {.size = size, .color = p.muted, .align = HAlign::right});
    }
}

void draw_numbers_below(Canvas& canvas, const ChartStyle& style, const Box& plot,
                        const std::vector<NumberBelow>& numbers, const std::string& name, bool across, bool moves) {
    const auto& [p, u, size] = style;
    const double axis = plot.bottom() + 0.5, baseline = axis + 9 * u + size, right = plot.right() + 8 * u;
    TextStyle text{.size = size, .color = p.muted, .align = HAlign::centre};
    const double room = right - canvas.measure(name, text).w - 10 * u;
    for (const NumberBelow& number : numbers) {
        const double x = moves ? number.x : middle_of_pixel(number.x);
        if (across)
            canvas.line({x, plot.y}, {x, plot.bottom()}, {p.grid, std::max(1.0, u), {}, Cap::butt});
        else
            canvas.line({x, axis}, {x, axis + 6 * u}, {p.muted, std::max(1.0, u), {}, Cap::butt});
        const double half = canvas.measure(number.text, text).w / 2;
        if (x + half < room && (!moves || x - half > plot.x - 20 * u)) canvas.text({x, baseline}, number.text, text);
    }
    text.align = HAlign::right;
    canvas.text({right, baseline}, name, text);
}

void outline_on(Canvas& canvas, const Palette& palette, double unit) {
    canvas.outline = palette.outline();
    if (canvas.outline) canvas.casing = Casing{*canvas.outline, 3 * unit};
}

}  // namespace beamcam::render
