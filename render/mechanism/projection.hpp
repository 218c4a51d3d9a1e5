// The projection of the mechanism's space to the picture, for bodies and for the marks on them.
//
// Lengths are pixels: x to the right, y up, z towards the viewer, the origin at the centre of the panel. The plane z =
// 0 is the plane of motion.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "render/draw/geometry.hpp"

namespace beamcam::render {

struct Vec3 {
    double x = 0, y = 0, z = 0;
    bool operator==(const Vec3&) const = default;
};
constexpr double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 normalized(Vec3 a) {
    const double n = std::sqrt(dot(a, a));
    return {a.x / n, a.y / n, a.z / n};
}

// A camera that looks at the origin, rotated by yaw about the vertical (positive: from the right) and by pitch
// (positive: from above), both less than a right angle.
struct Projection {
    Vec2 centre;                                                // of the picture [px]
    double distance = std::numeric_limits<double>::infinity();  // [px]; infinite: parallel
    double zoom = 1;                                            // magnification at the origin
    std::array<Vec3, 3> axes{};                                 // right, up and towards the viewer

    static Projection looking(Vec2 centre, double distance, double zoom, double yaw, double pitch);
    static Projection front(Vec2 centre);  // parallel: points of the plane of motion keep their places
    bool operator==(const Projection&) const = default;
    Vec2 to_pixels(Vec3 p) const;
    Vec3 towards_camera(Vec3 from) const;  // of any length
};

}  // namespace beamcam::render
