#include "sim/observe/pose.hpp"

namespace beamcam::sim {

std::vector<double> deflection(const Pose& pose) {
    const Vec2 across = perp(unit(pose.theta)), root = pose.centreline.front();
    std::vector<double> out;
    out.reserve(pose.centreline.size());
    for (const Vec2& r : pose.centreline) out.push_back(dot(r - root, across));
    return out;
}

}  // namespace beamcam::sim
