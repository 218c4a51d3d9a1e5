#include "render/mechanism/cam_outline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/numerics.hpp"
#include "sim/cam/cam_shape.hpp"
#include "sim/cam/motion_law.hpp"

namespace beamcam::render {

// The normal at each arc, ds/dα = ρ, from the one before on.
CamOutline cam_outline(const sim::Problem& problem, int count) {
    const auto shape = sim::cam_shape(problem);
    const double whole = shape->arc(sim::kFullTurn);
    CamOutline out;
    double alpha = 0;
    for (int i = 0; i < count; ++i) {
        const double s = whole * i / count;
        const auto ahead = [&](double at) { return std::pair(shape->arc(at) - s, shape->at(at).radius); };
        alpha = sim::increasing_root(ahead, alpha, sim::kFullTurn);
        out.points.push_back(shape->at(alpha).position(alpha));
        out.normals.push_back(sim::unit(alpha));
    }
    return out;
}

int outline_points(double reach) { return std::clamp(static_cast<int>(8 * std::sqrt(std::max(reach, 1.0))), 60, 480); }

sim::Vec2 on_cam(const sim::Pose& pose, sim::Vec2 point) {
    const sim::Vec2 along = sim::unit(pose.cam_angle);
    return pose.cam_centre + point.x * along + point.y * sim::perp(along);
}

std::vector<sim::Vec2> placed_outline(const sim::Problem& problem, const sim::Pose& pose, int count) {
    std::vector<sim::Vec2> out;
    for (const sim::Vec2 p : cam_outline(problem, count).points) out.push_back(on_cam(pose, p));
    out.push_back(out.front());
    return out;
}

double cam_reach(const sim::Problem& problem) { return sim::cam_shape(problem)->largest_reach(); }
double cam_circumference(const sim::Problem& problem) { return sim::cam_shape(problem)->arc(sim::kFullTurn); }

}  // namespace beamcam::render
