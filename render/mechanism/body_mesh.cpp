#include "render/mechanism/body_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beamcam::render {
namespace {

constexpr double kFade = 0.5;   // of an edge, inwards and outwards [px]
constexpr double kUnder = 1.5;  // of sides below the front [px]

// To the right of the way from a to b, where y is up; in the picture, where y is down, to its left.
Vec2 right_of(Vec2 a, Vec2 b) { return -sim::perp(normalized(b - a)); }

// For each corner of a polygon the step that moves both of its edges outwards by 1. `outwards`: of an edge.
std::vector<Vec2> miters(const std::vector<Vec2>& polygon) {
    const std::size_t n = polygon.size();
    std::vector<Vec2> out;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 a = right_of(polygon[(i + n - 1) % n], polygon[i]), b = right_of(polygon[i], polygon[(i + 1) % n]);
        out.push_back((a + b) * (1 / std::max(1 + dot(a, b), 0.3)));
    }
    return out;
}

}  // namespace

Prism cylinder(Vec2 centre, double radius) {
    constexpr int kMost = 160;  // sides; with a radius of 300 px the error is a sixteenth of a pixel
    const int sides = std::clamp(static_cast<int>(std::numbers::pi * std::sqrt(8 * radius)), 12, kMost);
    Prism p{.axis = centre, .turned = true};
    for (int i = 0; i < sides; ++i) {
        p.outward.push_back(sim::unit(2 * std::numbers::pi * i / sides));
        p.outline.push_back(centre + p.outward.back() * radius);
    }
    return p;
}

Prism block(std::span<const Vec2> corners) {
    Prism p{.outline = {corners.begin(), corners.end()}};
    for (const Vec2 m : miters(p.outline)) p.outward.push_back(normalized(m));
    return p;
}

std::uint32_t BodyMesh::vertex(const Point& p, Vec2 pixel, double cover) {
    const Vec3 n = normalized(p.normal);
    vertices.push_back({{float(pixel.x), float(pixel.y)},
                        {float(p.at.x), float(p.at.y), float(p.at.z)},
                        {float(n.x), float(n.y), float(n.z)},
                        {float(p.color.r), float(p.color.g), float(p.color.b), float(cover)},
                        {float(p.across.x), float(p.across.y)}});
    return static_cast<std::uint32_t>(vertices.size() - 1);
}

void BodyMesh::band(const Ring& outer, const Ring& inner) {
    for (std::size_t i = 0; i < outer.size(); ++i) {
        const std::size_t next = (i + 1) % outer.size();
        quad(outer[i], outer[next], inner[next], inner[i]);
    }
}

// Cuts off every second corner until nothing is left: large triangles are drawn faster than slivers around a centre.
void BodyMesh::fill(Ring polygon) {
    while (polygon.size() > 2) {
        Ring rest;
        for (std::size_t i = 0; i < polygon.size(); i += 2) {
            rest.push_back(polygon[i]);
            if (i + 1 < polygon.size())
                corners.insert(corners.end(), {polygon[i], polygon[i + 1], polygon[(i + 2) % polygon.size()]});
        }
        polygon = std::move(rest);
    }
}

// A flat piece of a side. Its first and last corner are at the front, below which it goes on by the steps `under`;
// its edges from the first to the second corner, to the third, to the last fade if they are outermost.
void BodyMesh::side(const std::array<Point, 4>& corner, std::array<bool, 4> fades, std::array<Vec2, 2> under) {
    std::array<Vec2, 4> px;
    for (std::size_t k = 0; k < 4; ++k) px[k] = view_.to_pixels(corner[k].at);
    const Vec2 middle = (px[0] + px[1] + px[2] + px[3]) * 0.25;
    const std::uint32_t first = vertex(corner[0], px[0], 1), last = vertex(corner[3], px[3], 1);
    quad(first, vertex(corner[1], px[1], 1), vertex(corner[2], px[2], 1), last);
    quad(first, last, vertex(corner[3], px[3] + under[1], 1), vertex(corner[0], px[0] + under[0], 1));
    for (std::size_t k = 0; k < 3; ++k) {
        if (!fades[k]) continue;
        const Vec2 a = px[k], b = px[k + 1], across = sim::perp(normalized(b - a));
        const Vec2 out = across * (dot(a - middle, across) > 0 ? 2 * kFade : -2 * kFade);
        quad(vertex(corner[k], a, 1), vertex(corner[k + 1], b, 1), vertex(corner[k + 1], b + out, 0),
             vertex(corner[k], a + out, 0));
    }
}

void BodyMesh::add(const Prism& p, Color color) {
    const std::size_t n = p.outline.size();
    const auto point = [&](std::size_t i, double z, Vec3 normal) {
        return Point{{p.outline[i].x, p.outline[i].y, z}, normal, color, p.turned ? p.outline[i] - p.axis : Vec2{}};
    };
    std::vector<Vec2> front;
    std::vector<bool> seen;  // sides
    for (std::size_t i = 0; i < n; ++i) {
        front.push_back(view_.to_pixels(point(i, p.front, {}).at));
        const Vec2 out = right_of(p.outline[i], p.outline[(i + 1) % n]);
        const Vec3 eye = view_.towards_camera(point(i, p.front, {}).at);
        seen.push_back(dot(out, {eye.x, eye.y}) > 1e-6);
    }
    std::vector<Vec2> steps = miters(front);  // inwards, since y is down
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t k = (i + 1) % n;
        if (!seen[i] || p.back >= p.front) continue;
        const Vec2 flat = right_of(p.outline[i], p.outline[k]), a = p.turned ? p.outward[i] : flat,
                   b = p.turned ? p.outward[k] : flat;
        const Vec3 u{a.x, a.y, 0}, v{b.x, b.y, 0};
        side({point(i, p.front, u), point(i, p.back, u), point(k, p.back, v), point(k, p.front, v)},
             {!seen[(i + n - 1) % n], true, !seen[k], false}, {steps[i] * kUnder, steps[k] * kUnder});
    }
    const auto ring = [&](double inset, double outward, double cover) {
        Ring out;
        for (std::size_t i = 0; i < n; ++i) {
            Point at = point(i, p.front, {outward * p.outward[i].x, outward * p.outward[i].y, 1});
            at.at.x -= p.outward[i].x * inset, at.at.y -= p.outward[i].y * inset;
            if (p.turned) at.across = at.across - p.outward[i] * inset;
            out.push_back(vertex(at, front[i] + steps[i] * inset, cover));
        }
        return out;
    };
    const double turn = p.chamfer > 0 ? 1 : 0;
    const Ring edge = ring(kFade, turn, 1);
    band(ring(-kFade, turn, 0), edge);
    if (p.chamfer <= 0) return fill(edge);
    const Ring inner = ring(std::max(p.chamfer, 2 * kFade) * view_.zoom, 0, 1);
    band(edge, inner);
    if (p.band > 0) return band(inner, ring(p.band * view_.zoom, 0, 1));
    fill(inner);
}

// The side towards the camera, the far pieces first.
void BodyMesh::add_sides(const Bar& bar) {
    const std::size_t last = bar.low.size() - 1;
    const Vec2 along = bar.low[last] - bar.low[0];
    const Vec3 eye = view_.towards_camera({bar.low[0].x, bar.low[0].y, 0});
    const bool outwards = dot(along, Vec2{eye.x, eye.y}) > 0;
    for (std::size_t step = 0; step < last; ++step) {
        const std::size_t i = outwards ? step : last - 1 - step;
        for (const double way : {-1.0, 1.0}) {
            const std::vector<Vec2>&edge = way < 0 ? bar.low : bar.high, &other = way < 0 ? bar.high : bar.low;
            const Vec2 out = normalized(edge[i] - other[i]);
            const Vec3 towards = view_.towards_camera({edge[i].x, edge[i].y, bar.half});
            if (dot(out, {towards.x, towards.y}) <= 1e-6) continue;
            const auto point = [&](std::size_t k, double z) {
                return Point{{edge[k].x, edge[k].y, z}, {out.x, out.y, 0}, bar.colors[k], out};
            };
            const auto under = [&](std::size_t k) {
                return normalized(view_.to_pixels({other[k].x, other[k].y, bar.half}) -
                                  view_.to_pixels({edge[k].x, edge[k].y, bar.half})) *
                       kUnder;
            };
            side({point(i, bar.half), point(i, -bar.half), point(i + 1, -bar.half), point(i + 1, bar.half)},
                 {false, true, false, false}, {under(i), under(i + 1)});
        }
    }
}

// The end at the tip; the root is in its clamp.
void BodyMesh::add_end(const Bar& bar) {
    const std::size_t last = bar.low.size() - 1;
    const Vec2 low = bar.low[last], high = bar.high[last], out = normalized(low - bar.low[last - 1]);
    const Vec3 eye = view_.towards_camera({low.x, low.y, bar.half});
    if (dot(out, {eye.x, eye.y}) <= 1e-6) return;
    const auto point = [&](Vec2 p, double z) { return Point{{p.x, p.y, z}, {out.x, out.y, 0}, bar.colors[last], {}}; };
    const auto inwards = [&](Vec2 p) {
        return (view_.to_pixels({p.x - out.x, p.y - out.y, bar.half}) - view_.to_pixels({p.x, p.y, bar.half})) * kUnder;
    };
    side({point(low, bar.half), point(low, -bar.half), point(high, -bar.half), point(high, bar.half)},
         {true, true, true, false}, {inwards(low), inwards(high)});
}

void BodyMesh::add(const Bar& bar) {
    add_sides(bar);
    add_end(bar);
    const std::size_t last = bar.low.size() - 1;
    const double chamfer = std::max(bar.chamfer, 2 * kFade);
    Ring before;
    // Six points across the front, shifted along the bar, whose normals lean so far forwards along it.
    const auto row = [&](std::size_t i, double along, double lean, double cover) {
        const Vec2 low = bar.low[i], high = bar.high[i], up = normalized(high - low), way = -sim::perp(up);
        const double depth = norm(high - low), edge = std::min(chamfer, 0.5 * depth), fade = kFade / view_.zoom;
        Ring now;
        const auto put = [&](double height, double slope, double share) {
            const Vec2 at = low + up * height + way * along;
            const Point p{{at.x, at.y, bar.half},
                          {slope * up.x + lean * way.x, slope * up.y + lean * way.y, 1},
                          bar.colors[i],
                          up};
            now.push_back(vertex(p, view_.to_pixels(p.at), share * cover));
        };
        put(-fade, -1, 0), put(std::min(fade, 0.5 * depth), -1, 1), put(edge, -bar.lean, 1);
        put(depth - edge, bar.lean, 1), put(std::max(depth - fade, 0.5 * depth), 1, 1), put(depth + fade, 1, 0);
        for (std::size_t k = 0; k + 1 < now.size() && !before.empty(); ++k)
            quad(before[k], now[k], now[k + 1], before[k + 1]);
        before = std::move(now);
    };
    const double fade = kFade / view_.zoom;
    row(0, -fade, 0, 0);
    row(0, fade, 0, 1);
    for (std::size_t i = 1; i < last; ++i) row(i, 0, 0, 1);
    if (norm(bar.low[last] - bar.low[last - 1]) > chamfer) row(last, -chamfer, 0, 1);
    row(last, -fade, 1, 1);
    row(last, fade, 1, 0);
}

}  // namespace beamcam::render
