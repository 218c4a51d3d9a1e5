// The outline of the cam for pictures.
#pragma once

#include <vector>

#include "sim/base/vec2.hpp"
#include "sim/observe/pose.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::render {

// Points at equal distances along the outline, counter-clockwise from the normal 0, where contact_s is 0.
struct CamOutline {
    std::vector<sim::Vec2> points, normals;  // in the cam's frame [m]; outward, of length 1
};
CamOutline cam_outline(const sim::Problem& problem, int count);

// Number of points of an outline of that size on the picture or page [px]: its sides are not seen.
int outline_points(double reach);

// A point of the cam's frame in fixed axes, at that pose.
sim::Vec2 on_cam(const sim::Pose& pose, sim::Vec2 point);
// A closed curve: the cam at that pose, in fixed axes [m].
std::vector<sim::Vec2> placed_outline(const sim::Problem& problem, const sim::Pose& pose, int count);

double cam_reach(const sim::Problem& problem);          // of the circle about C that the cam sweeps [m]
double cam_circumference(const sim::Problem& problem);  // length of the outline [m]

}  // namespace beamcam::render
