#include "render/mechanism/projection.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {

Projection Projection::looking(Vec2 centre, double distance, double zoom, double yaw, double pitch) {
    const double cy = std::cos(yaw), sy = std::sin(yaw), cp = std::cos(pitch), sp = std::sin(pitch);
    return {centre, distance, zoom, {Vec3{cy, 0, -sy}, Vec3{-sy * sp, cp, -cy * sp}, Vec3{sy * cp, sp, cy * cp}}};
}

Projection Projection::front(Vec2 centre) { return looking(centre, std::numeric_limits<double>::infinity(), 1, 0, 0); }

Vec2 Projection::to_pixels(Vec3 p) const {
    constexpr double kNearest = 0.1;  // of the distance; nothing that is drawn is nearer
    const double nearer = zoom / std::max(1 - dot(axes[2], p) / distance, kNearest);
    return {centre.x + nearer * dot(axes[0], p), centre.y - nearer * dot(axes[1], p)};
}

Vec3 Projection::towards_camera(Vec3 from) const {
    const Vec3 &near = axes[2], off{from.x / distance, from.y / distance, from.z / distance};
    return {near.x - off.x, near.y - off.y, near.z - off.z};
}

}  // namespace beamcam::render
