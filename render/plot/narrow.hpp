// Narrow spikes of dashed curves, in which dashes would hide the peaks.
#pragma once

#include <vector>

#include "render/draw/painter.hpp"

namespace beamcam::render {

// The pieces of a curve, separated by NaN.
struct DashedCurve {
    std::vector<Vec2> dashed, solid;
};

// A piece is solid if the curve within a third of the `period` of its dashes, measured along x, goes more than three
// periods up and back. Curves that are not functions of x stay dashed.
DashedCurve without_dashes_in_spikes(const std::vector<Vec2>& points, double period);

// Strokes a curve, dashed by the pen except in narrow spikes.
void stroke_curve(Painter& on, const std::vector<Vec2>& points, Pen pen);

}  // namespace beamcam::render
