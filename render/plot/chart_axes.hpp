// The axes of charts in films: a grid line at every number of the left axis, and numbers below the plot.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "render/draw/canvas.hpp"
#include "render/plot/axis.hpp"

namespace beamcam::render {

// An axis from `low` < `high`, widened to round ends. `symbol`: Pango markup; `unit`: "" for none; `most`: ticks, >= 2.
AxisMap chart_axis(double low, double high, const std::string& symbol, const std::string& unit, int most);

// Letters of headings and readings are larger than those at axes [px].
inline double heading_size(double unit, double numbers) { return std::max(21 * unit, 1.14 * numbers); }

// The common style of the charts of a film.
struct ChartStyle {
    const Palette& palette;
    double unit;     // [px] of a design pixel
    double numbers;  // size of the letters at axes [px]

    double heading() const { return heading_size(unit, numbers); }
};
void draw_levels(Canvas& canvas, const ChartStyle& style, const AxisMap& axis, const Box& plot);

// A number below the plot.
struct NumberBelow {
    double x = 0;  // [px]
    std::string text;
};
// Draws the numbers, and the name of their axis at the right end if they leave it room. `across`: grid lines, else
// short ticks. `moves`: the numbers move with time, so they are not rounded to pixels.
void draw_numbers_below(Canvas& canvas, const ChartStyle& style, const Box& plot,
                        const std::vector<NumberBelow>& numbers, const std::string& name, bool across,
                        bool moves = false);

// Sets the outlines of texts and lines in pictures without paper.
void outline_on(Canvas& canvas, const Palette& palette, double unit);

}  // namespace beamcam::render
