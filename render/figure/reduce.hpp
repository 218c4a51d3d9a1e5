// Curves reduced to what a device can show, so that a million points draw and weigh as little as a few thousand.
#pragma once

#include <span>
#include <vector>

#include "render/geometry.hpp"

namespace beamcam::render::figure {

// Points in units of the sheet; NaN breaks the line and stays. `grain`: the smallest distance that shows.
// Where x increases: the first, least, greatest and last of each column of width `grain`. Elsewhere: points closer than
// `grain` to the last kept one are left out, extremes of the excursion kept.
std::vector<Vec2> reduce(std::span<const Vec2> points, double grain);

}  // namespace beamcam::render::figure
