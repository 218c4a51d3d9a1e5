// The axes of charts in films: a line across the plot at every number at the left, and numbers below it.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "render/draw/canvas.hpp"
#include "render/plot/axis.hpp"

namespace beamcam::render {

// An axis of values from `low` to `high`, low < high, whose outermost marks carry numbers. `symbol`: Pango's markup;
// `unit` "" for none; `most` >= 2 marks.
AxisMap chart_axis(double low, double high, const std::string& symbol, const std::string& unit, int most);

// Letters of headings and readings are larger than those at axes [px].
inline double heading_size(double unit, double numbers) { return std::max(21 * unit, 1.14 * numbers); }

// What charts of a film have in common.
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
// With the name of their axis at the right end, where numbers leave it room. `across`: lines through the plot, else
// short ticks. `moves`: numbers come in at one side and leave at the other, between pixels.
void draw_numbers_below(Canvas& canvas, const ChartStyle& style, const Box& plot,
                        const std::vector<NumberBelow>& numbers, const std::string& name, bool across,
                        bool moves = false);

}  // namespace beamcam::render
