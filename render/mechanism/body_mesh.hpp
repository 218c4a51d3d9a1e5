// Bodies as triangles of the picture, in the order in which they cover each other: nearer ones are added later.
//
// Bodies extend along z, towards the viewer, and are seen from the front. The edges of faces fade over a pixel, which
// is smoother than samples; faces overlap below these edges. A chamfer is a strip along the edge of the front, whose
// normals turn from outwards to forwards.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/draw/color.hpp"
#include "render/mechanism/projection.hpp"

namespace beamcam::render {

struct BodyVertex {
    std::array<float, 2> pixel{};
    std::array<float, 3> at{}, normal{};  // in space [px], for the light
    std::array<float, 4> color{};         // alpha: how much of the pixel is covered
    std::array<float, 2> across{};  // across the scratches of turned or drawn metal, in the plane; 0: there are none
};

// A prism over a convex outline.
struct Prism {
    std::vector<Vec2> outline{}, outward{};  // counter-clockwise; unit normals
    double back = 0, front = 0, chamfer = 0;
    double band = 0;      // of the front only a band of this width along its edge is drawn; 0: all of it
    Vec2 axis{};          // of the lathe
    bool turned = false;  // round, and scratches run around the axis; otherwise sides are flat
};
Prism cylinder(Vec2 centre, double radius);
Prism block(std::span<const Vec2> corners);

// A bar with these edges, from z = −half to half.
struct Bar {
    std::vector<Vec2> low, high;  // of the same size >= 2, the first to the right of the second
    std::vector<Color> colors;
    double half = 0, chamfer = 0;
    double lean = 0;  // the front is slightly convex: its normals lean outwards by this slope at the edges
};

class BodyMesh {
  public:
    explicit BodyMesh(const Projection& view) : view_(view) {}

    void add(const Prism& p, Color color);
    void add(const Bar& bar);

    std::vector<BodyVertex> vertices;
    std::vector<std::uint32_t> corners;  // three per triangle

  private:
    using Ring = std::vector<std::uint32_t>;
    struct Point {
        Vec3 at, normal;
        Color color;
        Vec2 across;
    };
    std::uint32_t vertex(const Point& p, Vec2 pixel, double cover);
    void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        corners.insert(corners.end(), {a, b, c, a, c, d});
    }
    void band(const Ring& outer, const Ring& inner);
    void fill(Ring polygon);
    void side(const std::array<Point, 4>& corner, std::array<bool, 4> fades, std::array<Vec2, 2> under);
    void add_sides(const Bar& bar);
    void add_end(const Bar& bar);

    const Projection& view_;
};

}  // namespace beamcam::render
