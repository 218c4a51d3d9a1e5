// A smooth curve through the positions of a moving point, one per frame.
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

// The curve of a point that rotates about `centre` by `turn` [rad], counter-clockwise on the screen, from one position
// to another; its distance from the centre changes linearly with the angle. For rotations too large for a spline,
// including whole turns.
std::vector<Vec2> turning_piece(Vec2 centre, Vec2 from, Vec2 to, double turn, double step);

}  // namespace beamcam::render
