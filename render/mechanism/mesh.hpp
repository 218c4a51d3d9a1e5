// Bodies as triangle meshes for the solid view (gl/solid.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/draw/color.hpp"
#include "render/draw/geometry.hpp"

namespace beamcam::render {

struct Vec3 {
    double x = 0, y = 0, z = 0;
    bool operator==(const Vec3&) const = default;
};

struct MeshVertex {
    std::array<float, 3> place{}, normal{};
    std::array<float, 4> color{};
};

// A cylinder along z, with a chamfer at its front edge and a bore, which need not be concentric.
struct Cylinder {
    Vec2 centre;
    double radius = 0, back = 0, front = 0;
    int sides = 0;       // a multiple of 4, so that the front has large triangles
    double chamfer = 0;  // 0: none
    Vec2 hole = {};
    double bore = 0;      // radius; 0: none
    bool closed = false;  // has a back, which is never visible from the front
};

// A prism along z over a convex outline, with a chamfer at its front edge and a round bore.
struct Prism {
    std::vector<Vec2> outline, outward;  // counter-clockwise; unit normals
    double back = 0, front = 0, chamfer = 0;
    Vec2 hole;
    double bore = 0;
};

// Any number of sides, at least 12, that Cylinder::sides accepts.
constexpr int whole_sides(double sides) { return 4 * std::max(3, static_cast<int>(sides / 4 + 0.999)); }

struct Mesh {
    static constexpr std::size_t kRing = 8;  // vertices of a bar at each station; four at each end follow

    std::vector<MeshVertex> vertices;
    std::vector<std::uint32_t> corners;  // three per triangle, counter-clockwise seen from outside

    void box(Vec3 low, Vec3 high, Color color);
    // `rim`: colours of the side, counter-clockwise from the direction `mark` [rad], alpha 0: `color`; may be empty.
    void cylinder(const Cylinder& c, Color color, const std::vector<Color>& rim = {}, double mark = 0);
    // `rim`: colours of the side from the first point of the outline on, equally spaced, as of a cylinder.
    void prism(const Prism& p, Color color, const std::vector<Color>& rim = {});
    // A bar with the given edges, `half` wide to either side of the plane z = 0.
    void bar(std::vector<Vec2> face, std::vector<Vec2> back, const std::vector<Color>& colors, double half);
    void quad(const std::array<Vec3, 4>& at, Vec3 normal, Color color);

  private:
    std::uint32_t add(Vec3 place, Vec3 normal, Color color);
    std::vector<std::uint32_t> ring(const Cylinder& c, double radius, double z, Vec3 slope, Color color);
    void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
    void band(const std::vector<std::uint32_t>& low, const std::vector<std::uint32_t>& high);
    void cut_ears(std::vector<std::uint32_t>& ring);
    void front(const Cylinder& c, double radius, Color color);
};

}  // namespace beamcam::render
