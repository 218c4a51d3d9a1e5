// Boxes and the map from the mechanism's plane [m, Y up] to the picture [px, y down].
#pragma once

#include <algorithm>
#include <limits>

#include "sim/base/vec2.hpp"

namespace beamcam::render {

using sim::Vec2;

// Of length 1; zero stays zero.
inline Vec2 normalized(Vec2 a) { return norm(a) > 0 ? a * (1 / norm(a)) : Vec2{}; }

struct Box {
    double x = 0, y = 0, w = 0, h = 0;  // [px] or [m]
    constexpr double right() const { return x + w; }
    constexpr double bottom() const { return y + h; }
    constexpr Vec2 centre() const { return {x + w / 2, y + h / 2}; }
    constexpr bool empty() const { return !(w > 0 && h > 0); }
    constexpr bool contains(const Box& o, double slack = 0) const {
        return o.x >= x - slack && o.y >= y - slack && o.right() <= right() + slack && o.bottom() <= bottom() + slack;
    }
    constexpr bool overlaps(const Box& o) const {
        return x < o.right() && o.x < right() && y < o.bottom() && o.y < bottom();
    }
    constexpr Box inset(double d) const { return {x + d, y + d, w - 2 * d, h - 2 * d}; }
    constexpr bool operator==(const Box&) const = default;
};

// The smallest box around points and circles.
struct Bounds {
    double x0 = std::numeric_limits<double>::infinity(), y0 = x0, x1 = -x0, y1 = -x0;
    void add(Vec2 p, double r = 0) {
        x0 = std::min(x0, p.x - r), x1 = std::max(x1, p.x + r);
        y0 = std::min(y0, p.y - r), y1 = std::max(y1, p.y + r);
    }
    bool empty() const { return !(x0 <= x1); }
    Box box() const { return empty() ? Box{} : Box{x0, y0, x1 - x0, y1 - y0}; }
};

// px = origin + scale·(x, −y): preserves angles and proportions.
struct Camera {
    double scale = 1;  // [px/m]
    Vec2 origin;       // of the world, in the picture [px]
    Vec2 to_pixels(Vec2 world) const { return {origin.x + scale * world.x, origin.y - scale * world.y}; }
    Vec2 to_world(Vec2 px) const { return {(px.x - origin.x) / scale, (origin.y - px.y) / scale}; }
};

// The largest camera that shows `world` centred within `box`. Both must have a positive size.
inline Camera fit(const Bounds& world, const Box& box) {
    const double w = world.x1 - world.x0, h = world.y1 - world.y0;
    Camera camera;
    camera.scale = std::min(box.w / w, box.h / h);
    const Vec2 middle{(world.x0 + world.x1) / 2, (world.y0 + world.y1) / 2};
    camera.origin = {box.centre().x - camera.scale * middle.x, box.centre().y + camera.scale * middle.y};
    return camera;
}

}  // namespace beamcam::render
