#include "render/mechanism/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beamcam::render {
namespace {

constexpr double kWholeTurn = 2 * std::numbers::pi;

Vec3 unit_of(Vec3 a) {
    const double n = std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
    return n > 0 ? Vec3{a.x / n, a.y / n, a.z / n} : Vec3{0, 0, 1};
}

// The colour of the side at an angle.
Color side_color(const std::vector<Color>& rim, double angle, Color otherwise) {
    const double turns = angle / kWholeTurn;
    const auto place = static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(rim.size()));
    const Color& touched = rim[std::min(place, rim.size() - 1)];
    return touched.a > 0 ? touched : otherwise;
}

}  // namespace

std::uint32_t Mesh::add(Vec3 p, Vec3 n, Color c) {
    vertices.push_back({{float(p.x), float(p.y), float(p.z)},
                        {float(n.x), float(n.y), float(n.z)},
                        {float(c.r), float(c.g), float(c.b), float(c.a)}});
    return static_cast<std::uint32_t>(vertices.size() - 1);
}

void Mesh::quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    corners.insert(corners.end(), {a, b, c, a, c, d});
}

void Mesh::quad(const std::array<Vec3, 4>& at, Vec3 normal, Color color) {
    const std::uint32_t first = add(at[0], normal, color);
    for (std::size_t k = 1; k < 4; ++k) add(at[k], normal, color);
    quad(first, first + 1, first + 2, first + 3);
}

void Mesh::box(Vec3 low, Vec3 high, Color color) {
    const auto [x, y, z] = low;
    const auto [u, v, w] = high;
    quad({{{x, y, w}, {u, y, w}, {u, v, w}, {x, v, w}}}, {0, 0, 1}, color);
    quad({{{u, y, z}, {x, y, z}, {x, v, z}, {u, v, z}}}, {0, 0, -1}, color);
    quad({{{u, v, z}, {x, v, z}, {x, v, w}, {u, v, w}}}, {0, 1, 0}, color);
    quad({{{x, y, z}, {u, y, z}, {u, y, w}, {x, y, w}}}, {0, -1, 0}, color);
    quad({{{u, y, z}, {u, v, z}, {u, v, w}, {u, y, w}}}, {1, 0, 0}, color);
    quad({{{x, v, z}, {x, y, z}, {x, y, w}, {x, v, w}}}, {-1, 0, 0}, color);
}

// `slope`: the normal is that much radial (x) and along z (z).
std::vector<std::uint32_t> Mesh::ring(const Cylinder& c, double radius, double z, Vec3 slope, Color color) {
    std::vector<std::uint32_t> out;
    for (int i = 0; i < c.sides; ++i) {
        const Vec2 way = sim::unit(kWholeTurn * i / c.sides), at = c.centre + way * radius;
        out.push_back(add({at.x, at.y, z}, unit_of({slope.x * way.x, slope.x * way.y, slope.z}), color));
    }
    return out;
}

// Quads between two rings of equal size.
void Mesh::band(const std::vector<std::uint32_t>& low, const std::vector<std::uint32_t>& high) {
    for (std::size_t i = 0; i < low.size(); ++i) {
        const std::size_t next = (i + 1) % low.size();
        quad(low[i], low[next], high[next], high[i]);
    }
}

// Removes every second corner of a convex polygon, with the triangle at it.
void Mesh::cut_ears(std::vector<std::uint32_t>& ring) {
    std::vector<std::uint32_t> rest;
    for (std::size_t i = 0; i < ring.size(); i += 2) {
        rest.push_back(ring[i]);
        if (i + 1 < ring.size()) corners.insert(corners.end(), {ring[i], ring[i + 1], ring[(i + 2) % ring.size()]});
    }
    ring = std::move(rest);
}

// Large triangles are drawn faster than slivers between the centre and the edge.
void Mesh::front(const Cylinder& c, double radius, Color color) {
    std::vector<std::uint32_t> outer = ring(c, radius, c.front, {0, 0, 1}, color);
    const double reach = norm(c.hole - c.centre) + c.bore;
    const auto clears_hole = [&](std::size_t sides) {
        return c.bore <= 0 || radius * std::cos(kWholeTurn / 2 / static_cast<double>(sides)) > reach;
    };
    const std::size_t least = c.bore > 0 ? std::max<std::size_t>(12, outer.size() / 4) : 5;
    while (outer.size() % 2 == 0 && outer.size() / 2 >= least && clears_hole(outer.size() / 2)) cut_ears(outer);
    if (c.bore > 0) {
        Cylinder inside = c;
        inside.centre = c.hole, inside.sides = static_cast<int>(outer.size());
        band(outer, ring(inside, c.bore, c.front, {0, 0, 1}, color));
        const Color dark = mix(color, rgb(0), 0.25);
        band(ring(inside, c.bore, c.front, {-1, 0, 0}, dark), ring(inside, c.bore, c.back, {-1, 0, 0}, dark));
        return;
    }
    while (outer.size() > 2) cut_ears(outer);
}

void Mesh::cylinder(const Cylinder& c, Color color, const std::vector<Color>& rim, double mark) {
    const double edge = c.front - c.chamfer;
    if (rim.empty()) {
        const auto low = ring(c, c.radius, c.back, {1, 0, 0}, color);
        band(low, ring(c, c.radius, edge, {1, 0, 0}, color));
    }
    for (int i = 0; i < c.sides && !rim.empty(); ++i) {
        const double a = kWholeTurn * i / c.sides, b = kWholeTurn * (i + 1) / c.sides;
        const Color side = side_color(rim, (a + b) / 2 - mark, color);
        const Vec2 u = sim::unit(a), v = sim::unit(b), p = c.centre + u * c.radius, q = c.centre + v * c.radius;
        const std::uint32_t first = add({p.x, p.y, c.back}, {u.x, u.y, 0}, side);
        add({q.x, q.y, c.back}, {v.x, v.y, 0}, side);
        add({q.x, q.y, edge}, {v.x, v.y, 0}, side);
        add({p.x, p.y, edge}, {u.x, u.y, 0}, side);
        quad(first, first + 1, first + 2, first + 3);
    }
    if (c.chamfer > 0) {
        const auto low = ring(c, c.radius, edge, {1, 0, 1}, color);
        band(low, ring(c, c.radius - c.chamfer, c.front, {1, 0, 1}, color));
    }
    front(c, c.radius - c.chamfer, color);
    if (!c.closed) return;
    std::vector<std::uint32_t> under = ring(c, c.radius, c.back, {0, 0, -1}, color);
    std::ranges::reverse(under);
    while (under.size() > 2) cut_ears(under);
}

// Every point of the outline belongs to a point of the bore in the same direction from its centre.
void Mesh::prism(const Prism& p, Color color, const std::vector<Color>& rim) {
    const std::size_t n = p.outline.size();
    const double edge = p.front - p.chamfer;
    const Color dark = mix(color, rgb(0), 0.25);
    std::vector<std::uint32_t> low, high, face, hole, inner, deep;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 at = p.outline[i], out = p.outward[i], top = at - out * p.chamfer;
        const Vec2 way = (at - p.hole) * (1 / norm(at - p.hole)), bore = p.hole + way * p.bore;
        const Vec3 slanted = unit_of({out.x, out.y, 1}), in{-way.x, -way.y, 0};
        low.push_back(add({at.x, at.y, edge}, slanted, color));
        high.push_back(add({top.x, top.y, p.front}, slanted, color));
        face.push_back(add({top.x, top.y, p.front}, {0, 0, 1}, color));
        hole.push_back(add({bore.x, bore.y, p.front}, {0, 0, 1}, color));
        inner.push_back(add({bore.x, bore.y, p.front}, in, dark));
        deep.push_back(add({bore.x, bore.y, p.back}, in, dark));
    }
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t k = (i + 1) % n;
        const double middle = kWholeTurn * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
        const Color side = rim.empty() ? color : side_color(rim, middle, color);
        const Vec2 a = p.outline[i], b = p.outline[k], u = p.outward[i], v = p.outward[k];
        const std::uint32_t first = add({a.x, a.y, p.back}, {u.x, u.y, 0}, side);
        add({b.x, b.y, p.back}, {v.x, v.y, 0}, side);
        add({b.x, b.y, edge}, {v.x, v.y, 0}, side);
        add({a.x, a.y, edge}, {u.x, u.y, 0}, side);
        quad(first, first + 1, first + 2, first + 3);
    }
    band(low, high);
    band(face, hole);
    band(inner, deep);
}

void Mesh::bar(std::vector<Vec2> face, std::vector<Vec2> back, const std::vector<Color>& colors, double half) {
    const std::size_t n = face.size();
    // The section turns from face to back counter-clockwise about the direction from the first to the last station.
    if (cross(face[1] - face[0] + back[1] - back[0], back[0] - face[0]) < 0) std::swap(face, back);
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 f = face[i], b = back[i];
        const Vec3 down = unit_of({f.x - b.x, f.y - b.y, 0}), up{-down.x, -down.y, 0}, near{0, 0, 1}, far{0, 0, -1};
        const Color& c = colors[i];
        add({f.x, f.y, -half}, down, c), add({f.x, f.y, half}, down, c);
        add({f.x, f.y, half}, near, c), add({b.x, b.y, half}, near, c);
        add({b.x, b.y, half}, up, c), add({b.x, b.y, -half}, up, c);
        add({b.x, b.y, -half}, far, c), add({f.x, f.y, -half}, far, c);
    }
    for (std::uint32_t i = 0; i + 1 < n; ++i)
        for (std::uint32_t k = 0; k < kRing; k += 2) {
            const std::uint32_t at = first + kRing * i + k, next = at + kRing;
            quad(at, next, next + 1, at + 1);
        }
    for (const bool end : {false, true}) {
        const std::size_t i = end ? n - 1 : 0;
        const Vec2 along = end ? face[i] - face[i - 1] : face[0] - face[1], f = face[i], b = back[i];
        std::array<Vec3, 4> cap{{{f.x, f.y, -half}, {b.x, b.y, -half}, {b.x, b.y, half}, {f.x, f.y, half}}};
        if (!end) std::ranges::reverse(cap);
        quad(cap, unit_of({along.x, along.y, 0}), colors[i]);
    }
}

}  // namespace beamcam::render
