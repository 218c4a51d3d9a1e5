#include "render/gl/solid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beamcam::render {
namespace {

constexpr int kMostSides = 160;    // of a disc; with a radius of 300 px the error is a sixteenth of a pixel
constexpr double kNearest = 0.25;  // of the distance to the camera; the near plane of the shader is 0.2
constexpr double kBlur = 0.009;    // of a shadow, relative to the reach: three texels of 1024, seen obliquely

int sides(double radius) { return whole_sides(std::min<double>(std::numbers::pi * std::sqrt(8 * radius), kMostSides)); }

double dot3(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3 place_of(const MeshVertex& v) { return {v.place[0], v.place[1], v.place[2]}; }

// The smallest box around the shadow of a triangle on the wall at this z, within `reach`.
Box shadow_box(const Mesh& bodies, std::size_t corner, double wall, double reach) {
    Bounds out;
    for (std::size_t k = corner; k < corner + 3; ++k) {
        const Vec3 p = place_of(bodies.vertices[bodies.corners[k]]);
        const double fall = (p.z - wall) / kLightNear.z;
        const Vec2 at{p.x - fall * kLightNear.x, p.y - fall * kLightNear.y};
        out.add({std::clamp(at.x, -reach, reach), std::clamp(at.y, -reach, reach)}, kBlur * reach);
    }
    return out.box();
}

// The tiles of the picture in which shadows of bodies may fall on the wall.
DirtyTiles shadowed_tiles(const Mesh& bodies, const Perspective& view, double wall, double reach, const Box& picture) {
    DirtyTiles tiles(static_cast<int>(picture.w), static_cast<int>(picture.h));
    for (std::size_t i = 0; i < bodies.corners.size(); i += 3) {
        const Box box = shadow_box(bodies, i, wall, reach);
        Bounds seen;
        for (const Vec3 corner : {Vec3{box.x, box.y, wall}, Vec3{box.right(), box.y, wall},
                                  Vec3{box.right(), box.bottom(), wall}, Vec3{box.x, box.bottom(), wall}}) {
            if (!view.is_before(corner)) {
                tiles.add_all();
                return tiles;
            }
            seen.add(view.to_pixels(corner), 1);
        }
        tiles.add(seen.box());
    }
    return tiles;
}

// The wall within these tiles. The rest is transparent and not drawn, because its pixels are the most expensive of the
// picture. The edges are those of pixels, so there are no gaps, and no pixel is shaded twice.
void add_wall(Mesh& mesh, const DirtyTiles& tiles, const Perspective& view, double z) {
    tiles.for_each_run([&](double left, double top, double right, double bottom) {
        const std::optional<Vec3> a = view.seen_at({left, bottom}, z), b = view.seen_at({right, bottom}, z),
                                  c = view.seen_at({right, top}, z), d = view.seen_at({left, top}, z);
        if (a && b && c && d) mesh.quad({*a, *b, *c, *d}, {0, 0, 1}, {});
    });
}

// The tiles that bodies cover; all if a body is too near.
DirtyTiles covered_tiles(const Mesh& bodies, const Perspective& view, const Box& picture) {
    constexpr double kAround = 2;  // margin for rounding [px]
    DirtyTiles tiles(static_cast<int>(picture.w), static_cast<int>(picture.h));
    std::vector<Vec2> places;
    for (const MeshVertex& vertex : bodies.vertices) {
        if (!view.is_before(place_of(vertex))) tiles.add_all();
        places.push_back(view.to_pixels(place_of(vertex)));
    }
    for (std::size_t i = 0; i < bodies.corners.size(); i += 3) {
        Bounds triangle;
        for (std::size_t k = i; k < i + 3; ++k) triangle.add(places[bodies.corners[k]], kAround);
        tiles.add(triangle.box());
    }
    return tiles;
}

void append(Mesh& mesh, const Mesh& more) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
    for (const std::uint32_t corner : more.corners) mesh.corners.push_back(first + corner);
}

}  // namespace

Perspective Perspective::looking(Vec2 centre, double distance, double zoom, double yaw, double pitch) {
    Perspective p{centre, distance, zoom, {}};
    const double cy = std::cos(yaw), sy = std::sin(yaw), cp = std::cos(pitch), sp = std::sin(pitch);
    p.axes = {Vec3{cy, 0, -sy}, Vec3{-sy * sp, cp, -cy * sp}, Vec3{sy * cp, sp, cy * cp}};
    return p;
}

Vec2 Perspective::to_pixels(Vec3 p) const {
    const double nearer = zoom * distance / (distance - dot3(axes[2], p));
    return {centre.x + nearer * dot3(axes[0], p), centre.y - nearer * dot3(axes[1], p)};
}

bool Perspective::is_before(Vec3 p) const { return dot3(axes[2], p) <= (1 - kNearest) * distance; }

std::optional<Vec3> Perspective::seen_at(Vec2 px, double z) const {
    const Vec3 &right = axes[0], &up = axes[1], &near = axes[2];
    const double u = (px.x - centre.x) / zoom, v = (centre.y - px.y) / zoom;
    // From the camera through the point of this pixel in the plane of the origin.
    const Vec3 eye{near.x * distance, near.y * distance, near.z * distance};
    const Vec3 ray{right.x * u + up.x * v - eye.x, right.y * u + up.y * v - eye.y, right.z * u + up.z * v - eye.z};
    const double way = (z - eye.z) / ray.z;
    if (!(way > 0)) return {};
    const Vec3 at{eye.x + way * ray.x, eye.y + way * ray.y, z};
    if (!is_before(at)) return {};
    return at;
}

SolidScene solid_scene(const MechanismShape& shape, const Palette& palette, const Box& box, const Perspective& view,
                       double wide, double unit, const std::vector<Color>& rim) {
    SolidScene scene;
    scene.view = view;
    scene.shadow = palette.shadow;
    const Vec2 middle = box.centre();
    const auto up = [&](Vec2 p) { return Vec2{p.x - middle.x, middle.y - p.y}; };
    std::vector<Vec2> face, back;
    for (Vec2 p : shape.face) face.push_back(up(p));
    for (Vec2 p : shape.back) back.push_back(up(p));
    const double half = wide / 2;
    // Bodies within the box and their shadows; less of those outside, which a near camera does not see.
    const double size = std::max(box.w, box.h);
    scene.reach = std::min(1.6 * size, 0.97 * size + 2 * wide);
    Mesh bodies;
    const Color metal = palette.steel;
    const Vec2 hinge = up(shape.hinge);
    const auto cylinder = [&](Vec2 centre, double radius, double from, double to, double chamfer, Color color) {
        bodies.cylinder({centre, radius, from, to, sides(radius), chamfer}, color);
    };
    cylinder(hinge, shape.pin, kHubDepth * wide, kHubDepth * wide + 4 * unit, 1.5 * unit, palette.pin);
    cylinder(hinge, shape.hub, -kHubDepth * wide, kHubDepth * wide, 3 * unit, mix(metal, rgb(0xFFFFFF), 0.15));
    bodies.bar(face, back, shape.colors, half);
    if (shape.disc) {
        const DiscShape& d = *shape.disc;
        const double thick = kDiscDepth * wide, chamfer = std::min(3 * unit, 0.05 * d.radius);
        cylinder(up(d.axis), 0.8 * d.bore, -kMountDepth * wide, thick + 6 * unit, 1.5 * unit, palette.pin);
        if (d.outline.empty()) cylinder(up(d.centre), d.dot, thick, thick + 0.6, 0, mix(metal, rgb(0), 0.6));
        cylinder(up(d.mark), d.mark_radius, thick, thick + 0.6, 0, mix(metal, rgb(0), 0.45));
        if (!d.outline.empty()) {
            Prism cam{{}, {}, -thick, thick, chamfer, up(d.axis), d.bore};
            for (std::size_t i = 0; i < d.outline.size(); ++i) {
                cam.outline.push_back(up(d.outline[i]));
                cam.outward.push_back({d.outward[i].x, -d.outward[i].y});
            }
            bodies.prism(cam, metal, rim);
        } else
            bodies.cylinder({up(d.centre), d.radius, -thick, thick, rim.empty() ? sides(d.radius) : kMostSides, chamfer,
                             up(d.axis), d.bore},
                            metal, rim, d.angle);
    }
    // The bearing block, behind the beam, and the shaft through it.
    const double foot = shape.hub + 30 * unit;
    cylinder(hinge, 0.8 * shape.hub, -kMountDepth * wide, -kHubDepth * wide, 2 * unit, mix(metal, rgb(0), 0.12));
    bodies.box({hinge.x - 1.5 * shape.hub, hinge.y - foot - 10 * unit, -kMountDepth * wide},
               {hinge.x + 1.5 * shape.hub, hinge.y - foot, 0.75 * wide}, mix(metal, rgb(0), 0.3));
    bodies.box({hinge.x - 0.8 * shape.hub, hinge.y - foot, -kMountDepth * wide},
               {hinge.x + 0.8 * shape.hub, hinge.y, -0.75 * wide}, mix(metal, rgb(0), 0.12));
    const Box picture{0, 0, box.w, box.h};
    const double wall = kWallDepth * wide;
    const DirtyTiles shadows = shadowed_tiles(bodies, view, wall, scene.reach, picture);
    add_wall(scene.mesh, shadows, view, wall);
    scene.wall = scene.mesh.corners.size();
    append(scene.mesh, bodies);
    scene.seen = scene.bodies = covered_tiles(bodies, view, picture);
    scene.seen.add(shadows);
    return scene;
}

}  // namespace beamcam::render
