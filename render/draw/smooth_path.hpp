// A smooth curve through the places of something that moves, one a frame: between two frames the eye expects an arc,
// not its chord.
//
// Centripetal Catmull–Rom splines (Yuksel, Schaefer and Keyser, Computer-Aided Design 43, 747, 2011): through every
// point, without loops or cusps within a piece however unevenly the points are spaced, as in slow motion. The first and
// the last piece bend as their neighbours do.
#pragma once

#include <span>
#include <vector>

#include "render/draw/geometry.hpp"

namespace beamcam::render {

// The piece from points[i] to points[i + 1], both ends included, in steps of about `step` pixels; i + 1 <
// points.size().
std::vector<Vec2> smooth_piece(std::span<const Vec2> points, std::size_t i, double step);

// The way of a point that turns about `centre` by `turn` [rad], counterclockwise as it is seen, from one place to
// another: its distance changes in proportion to the angle. For what turns further between two frames than a spline
// through their places can tell, whole turns included.
std::vector<Vec2> turning_piece(Vec2 centre, Vec2 from, Vec2 to, double turn, double step);

}  // namespace beamcam::render
