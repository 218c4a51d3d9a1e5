// The ticks of an axis and their numbers: in films grid lines, or ticks that point away from the plot; in print ticks
// that point inwards.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/draw/canvas.hpp"
#include "render/plot/axis.hpp"

namespace beamcam::render {

enum class Side { left, right, top, bottom };

struct TickStyle {
    Pen pen;
    double major = 0, minor = 0;            // lengths into the plot; negative: away from it; 0: no line
    std::optional<TextStyle> numbers = {};  // none: no numbers
    Vec2 beside = {};                       // from the tick's place on the side to its number
    bool whole_pixels = false;              // in the middles of pixels, where thin lines are sharp
};
void draw_ticks(Painter& painter, std::span<const Tick> ticks, const Box& plot, Side side, const TickStyle& style);

// ---- the axes of charts in films ---------------------------------------------------------------------

// An axis from `low` < `high`, widened to round ends. `symbol`: markup; `unit`: "" for none; `most`: ticks, >= 2.
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
// A grid line at every number of the left axis.
void draw_levels(Canvas& canvas, const ChartStyle& style, const AxisMap& axis, const Box& plot);
// The numbers below the plot, and the name of their axis at the right end or before the last number. `across`: grid
// lines, else short ticks. `moves`: the numbers move with time, so they are not rounded to pixels.
void draw_numbers_below(Canvas& canvas, const ChartStyle& style, const Box& plot, std::vector<Tick> ticks,
                        const std::string& name, bool across, bool moves = false);

// Sets the outlines of texts and lines in pictures without paper.
void outline_on(Canvas& canvas, const Palette& palette, double unit);

}  // namespace beamcam::render
