// The ticks of an axis and their numbers: in films grid lines, or ticks that point away from the plot; in print ticks
// that point inwards.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/draw/painter.hpp"
#include "render/draw/text_style.hpp"
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

// The middle of the name of an axis in the row of its numbers below the plot: at the right end if the last number
// leaves room there, otherwise before the last number, as DIN 461 recommends, in place of the number before it if
// necessary. If the numbers move, those at the right end give way. Omits the numbers that give way.
double place_name(const Painter& painter, std::vector<Tick>& ticks, const Box& plot, const std::string& name,
                  const TextStyle& style, double unit, bool moves);

}  // namespace beamcam::render
