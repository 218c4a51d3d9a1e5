#include "render/gl/solid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace beamcam::render {
namespace {

using std::numbers::pi;
constexpr int kMostSides = 160;  // of a disc; with a radius of 300 px the error is a sixteenth of a pixel

int sides(double radius) { return std::clamp(static_cast<int>(std::ceil(pi * std::sqrt(8 * radius))), 12, kMostSides); }

Vec3 operator*(Vec3 a, double k) { return {a.x * k, a.y * k, a.z * k}; }
double dot3(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3 normalized(Vec3 a) {
    const double n = std::sqrt(dot3(a, a));
    return n > 0 ? a * (1 / n) : Vec3{0, 0, 1};
}

class Mesh {
  public:
    explicit Mesh(std::vector<SolidVertex>& out) : out_(out) {}

    void triangle(Vec3 a, Vec3 b, Vec3 c, Vec3 na, Vec3 nb, Vec3 nc, Color color) {
        vertex(a, na, color), vertex(b, nb, color), vertex(c, nc, color);
    }
    void quad(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 na, Vec3 nb, Vec3 nc, Vec3 nd, Color color) {
        triangle(a, b, c, na, nb, nc, color);
        triangle(a, c, d, na, nc, nd, color);
    }
    // A quadrilateral with one colour at a and d and another at b and c.
    void shaded(const std::array<Vec3, 4>& at, const std::array<Vec3, 4>& n, Color first, Color last) {
        const std::array<Color, 4> colors{first, last, last, first};
        for (const std::size_t k : {0, 1, 2, 0, 2, 3}) vertex(at[k], n[k], colors[k]);
    }
    void quad(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 n, Color color) { quad(a, b, c, d, n, n, n, n, color); }

    // A cylinder along z between `back` and `front` with a chamfer; `bore`: radius of a hole.
    void disc(Vec2 middle, double radius, double back, double front, double chamfer, Color color, Vec2 hole = {},
              double bore = 0, const std::vector<Color>& rim = {}, double mark = 0) {
        const double inner = radius - chamfer;
        const int count = rim.empty() ? sides(radius) : kMostSides;
        for (int i = 0; i < count; ++i) {
            const double a = 2 * pi * i / count, b = 2 * pi * (i + 1) / count;
            const Vec2 u{std::cos(a), std::sin(a)}, v{std::cos(b), std::sin(b)};
            const auto at = [&](Vec2 way, double r, double z) {
                return Vec3{middle.x + way.x * r, middle.y + way.y * r, z};
            };
            const auto out = [](Vec2 way, double z) { return normalized({way.x, way.y, z}); };
            Color side = color;
            if (!rim.empty()) {
                const double turns = ((a + b) / 2 - mark) / (2 * pi);
                const auto place =
                    static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(rim.size()));
                const Color& touched = rim[std::min(place, rim.size() - 1)];
                if (touched.a > 0) side = touched;
            }
            quad(at(u, radius, back), at(v, radius, back), at(v, radius, front - chamfer),
                 at(u, radius, front - chamfer), out(u, 0), out(v, 0), out(v, 0), out(u, 0), side);
            quad(at(u, radius, front - chamfer), at(v, radius, front - chamfer), at(v, inner, front),
                 at(u, inner, front), out(u, 1), out(v, 1), out(v, 1), out(u, 1), color);
            const auto hole_at = [&](Vec2 way, double z) {
                return Vec3{hole.x + way.x * bore, hole.y + way.y * bore, z};
            };
            const Vec3 n{0, 0, 1};
            if (bore > 0) {
                quad(at(u, inner, front), at(v, inner, front), hole_at(v, front), hole_at(u, front), n, color);
                quad(hole_at(u, back), hole_at(v, back), hole_at(v, front), hole_at(u, front), out(u * -1, 0),
                     out(v * -1, 0), out(v * -1, 0), out(u * -1, 0), mix(color, rgb(0), 0.25));
            } else {
                triangle(at(u, inner, front), at(v, inner, front), {middle.x, middle.y, front}, n, n, n, color);
            }
        }
    }

    // A bar with the given edges, `half` wide to either side of the plane of motion.
    void bar(const std::vector<Vec2>& face, const std::vector<Vec2>& back, const std::vector<Color>& colors,
             double half) {
        const std::size_t n = face.size();
        for (std::size_t i = 0; i + 1 < n; ++i) {
            const auto normal = [&](std::size_t k) {
                const Vec2 across = face[k] - back[k];
                return normalized({across.x, across.y, 0});
            };
            const Vec3 p = normal(i), q = normal(i + 1);
            const auto at = [&](Vec2 v, double z) { return Vec3{v.x, v.y, z}; };
            const Color first = colors[i], last = colors[i + 1];
            const Vec3 front{0, 0, 1};
            shaded({at(face[i], -half), at(face[i + 1], -half), at(face[i + 1], half), at(face[i], half)}, {p, q, q, p},
                   first, last);
            shaded({at(back[i], -half), at(back[i + 1], -half), at(back[i + 1], half), at(back[i], half)},
                   {p * -1, q * -1, q * -1, p * -1}, first, last);
            shaded({at(face[i], half), at(face[i + 1], half), at(back[i + 1], half), at(back[i], half)},
                   {front, front, front, front}, first, last);
        }
        for (const std::size_t k : {std::size_t{0}, n - 1}) {
            const Vec2 along = k == 0 ? face[0] - face[1] : face[k] - face[k - 1];
            quad({face[k].x, face[k].y, -half}, {back[k].x, back[k].y, -half}, {back[k].x, back[k].y, half},
                 {face[k].x, face[k].y, half}, normalized({along.x, along.y, 0}), colors[k]);
        }
    }

    void box(double x0, double x1, double y0, double y1, double z0, double z1, Color c) {
        quad({x0, y0, z1}, {x1, y0, z1}, {x1, y1, z1}, {x0, y1, z1}, {0, 0, 1}, c);
        quad({x0, y1, z0}, {x1, y1, z0}, {x1, y1, z1}, {x0, y1, z1}, {0, 1, 0}, c);
        quad({x0, y0, z0}, {x1, y0, z0}, {x1, y0, z1}, {x0, y0, z1}, {0, -1, 0}, c);
        quad({x1, y0, z0}, {x1, y1, z0}, {x1, y1, z1}, {x1, y0, z1}, {1, 0, 0}, c);
        quad({x0, y0, z0}, {x0, y1, z0}, {x0, y1, z1}, {x0, y0, z1}, {-1, 0, 0}, c);
    }

  private:
    void vertex(Vec3 p, Vec3 n, Color c) {
        out_.push_back({{float(p.x), float(p.y), float(p.z)},
                        {float(n.x), float(n.y), float(n.z)},
                        {float(c.r), float(c.g), float(c.b), float(c.a)}});
    }
    std::vector<SolidVertex>& out_;
};

// The cells of a square wall, from −far to far, on which shadows of bodies may fall. The rest of the wall is
// transparent and not drawn, because its pixels are the most expensive of the picture.
class ShadowedWall {
  public:
    ShadowedWall(double z, double reach) : z_(z), far_(reach), blur_(kBlur * reach) {}

    void cast(const std::vector<SolidVertex>& bodies) {
        for (std::size_t i = 0; i + 2 < bodies.size(); i += 3) {
            Vec2 low{far_, far_}, high{-far_, -far_};
            for (std::size_t k = i; k < i + 3; ++k) {
                const auto& [x, y, z] = bodies[k].place;
                const double fall = (double(z) - z_) / kLightNear.z;
                const Vec2 at{double(x) - fall * kLightNear.x, double(y) - fall * kLightNear.y};
                low = {std::min(low.x, at.x), std::min(low.y, at.y)};
                high = {std::max(high.x, at.x), std::max(high.y, at.y)};
            }
            for (int row = cell(low.y - blur_); row <= cell(high.y + blur_); ++row)
                for (int column = cell(low.x - blur_); column <= cell(high.x + blur_); ++column)
                    shadowed_[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = true;
        }
    }

    // Neighbouring cells share their corners, so there are no gaps.
    void build(Mesh& mesh) const {
        for (std::size_t row = 0; row < kCells; ++row)
            for (std::size_t column = 0; column < kCells; ++column) {
                if (!shadowed_[row][column]) continue;
                const double left = edge(column), right = edge(column + 1), low = edge(row), high = edge(row + 1);
                mesh.quad({left, low, z_}, {right, low, z_}, {right, high, z_}, {left, high, z_}, {0, 0, 1},
                          {0, 0, 0, 0});
            }
    }

  private:
    static constexpr std::size_t kCells = 88;
    static constexpr double kBlur = 0.009;  // relative to the reach: three texels of 1024, seen obliquely
    int cell(double at) const {
        const double share = (at + far_) / (2 * far_);
        return static_cast<int>(std::clamp(share, 0.0, 1.0) * (kCells - 1e-9));
    }
    double edge(std::size_t i) const { return far_ * (2 * double(i) / kCells - 1); }

    double z_, far_, blur_;
    std::array<std::array<bool, kCells>, kCells> shadowed_{};
};

// Whether a triangle faces the camera.
bool faces_camera(const SolidVertex* corners, const Perspective& view) {
    const auto vec = [](const std::array<float, 3>& a) { return Vec3{a[0], a[1], a[2]}; };
    const auto to = [](Vec3 a, Vec3 b) { return Vec3{b.x - a.x, b.y - a.y, b.z - a.z}; };
    const Vec3 a = vec(corners[0].place), b = vec(corners[1].place), c = vec(corners[2].place), u = to(a, b),
               v = to(a, c);
    const Vec3 plane{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    const double outside =
        dot3(plane, vec(corners[0].normal)) + dot3(plane, vec(corners[1].normal)) + dot3(plane, vec(corners[2].normal));
    const double eye = dot3(plane, to(a, view.axes[2] * view.distance));
    return outside == 0 || (outside > 0) == (eye >= 0);
}

// Appends the triangles that face the camera, then the others, which are hidden. The nearest bodies, which were built
// last, come first, so that the pixels they hide are not shaded. Returns the number of vertices that face the camera.
std::size_t append_front_first(const std::vector<SolidVertex>& bodies, const Perspective& view,
                               std::vector<SolidVertex>& out) {
    const std::size_t begin = out.size();
    std::size_t fronts = 0;
    for (const bool front : {true, false}) {
        for (std::size_t i = bodies.size(); i >= 3; i -= 3)
            if (faces_camera(&bodies[i - 3], view) == front)
                out.insert(out.end(), bodies.begin() + std::ptrdiff_t(i) - 3, bodies.begin() + std::ptrdiff_t(i));
        if (front) fronts = out.size() - begin;
    }
    return fronts;
}

// The part of the picture that the scene covers; the whole picture if a body is nearer than the near plane.
Box seen_part(const SolidScene& scene, const Box& picture) {
    constexpr double kNearest = 0.25;  // of the distance to the camera; the near plane of the shader is 0.2
    constexpr double kAround = 2;      // margin for rounding [px]
    Bounds seen;
    for (const SolidVertex& vertex : scene.triangles) {
        const Vec3 p{vertex.place[0], vertex.place[1], vertex.place[2]};
        if (dot3(scene.view.axes[2], p) > (1 - kNearest) * scene.view.distance) return picture;
        seen.add(scene.view.to_pixels(p), kAround);
    }
    return seen.box();
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
    std::vector<SolidVertex> bodies;
    Mesh mesh(bodies);
    const Color metal = palette.steel;
    const Vec2 hinge = up(shape.hinge);
    // The bearing block, behind the beam, and the shaft through it.
    const double foot = shape.hub + 30 * unit;
    mesh.box(hinge.x - 0.8 * shape.hub, hinge.x + 0.8 * shape.hub, hinge.y - foot, hinge.y, -1.5 * wide, -0.75 * wide,
             mix(metal, rgb(0), 0.12));
    mesh.box(hinge.x - 1.5 * shape.hub, hinge.x + 1.5 * shape.hub, hinge.y - foot - 10 * unit, hinge.y - foot,
             -1.5 * wide, 0.75 * wide, mix(metal, rgb(0), 0.3));
    mesh.disc(hinge, 0.8 * shape.hub, -1.5 * wide, -0.7 * wide, 2 * unit, mix(metal, rgb(0), 0.12));
    if (shape.disc) {
        const DiscShape& d = *shape.disc;
        const double thick = 0.62 * wide, chamfer = std::min(3 * unit, 0.05 * d.radius);
        mesh.disc(up(d.centre), d.radius, -thick, thick, chamfer, metal, up(d.axis), d.bore, rim, d.angle);
        mesh.disc(up(d.mark), d.mark_radius, thick, thick + 0.6, 0, mix(metal, rgb(0), 0.45));
        mesh.disc(up(d.centre), std::min(4 * unit, 0.06 * d.radius), thick, thick + 0.6, 0, mix(metal, rgb(0), 0.6));
        mesh.disc(up(d.axis), 0.8 * d.bore, -1.5 * wide, thick + 6 * unit, 1.5 * unit, palette.pin);
    }
    mesh.bar(face, back, shape.colors, half);
    mesh.disc(hinge, shape.hub, -0.7 * wide, 0.7 * wide, 3 * unit, mix(metal, rgb(0xFFFFFF), 0.15));
    mesh.disc(hinge, shape.pin, 0.7 * wide, 0.7 * wide + 4 * unit, 1.5 * unit, palette.pin);
    ShadowedWall wall(-1.55 * wide, scene.reach);
    wall.cast(bodies);
    Mesh behind(scene.triangles);
    wall.build(behind);
    scene.wall = scene.triangles.size();
    scene.front = scene.wall + append_front_first(bodies, view, scene.triangles);
    scene.seen = seen_part(scene, {0, 0, box.w, box.h});
    return scene;
}

}  // namespace beamcam::render
