#include "render/film/swept_region.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "render/film/mechanism_marks.hpp"

namespace beamcam::render {
namespace {

constexpr double kShadow = 0.004;  // weight of a shadow; that of a body is 1
constexpr int kDiscSides = 32;

// The corners of the convex hull, in their order (Andrew's monotone chain).
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
    if (points.size() < 3) return points;
    std::ranges::sort(points, [](Vec2 a, Vec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    std::vector<Vec2> hull;
    for (const bool lower : {true, false}) {
        const std::size_t first = hull.size();
        for (Vec2 p : points) {
            while (hull.size() >= first + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
                hull.pop_back();
            hull.push_back(p);
        }
        hull.pop_back();  // the first point of the other half
        if (lower) std::ranges::reverse(points);
    }
    return hull;
}

std::vector<Vec2> circle(Vec2 centre, double radius) {
    std::vector<Vec2> out;
    for (int i = 0; i < kDiscSides; ++i) out.push_back(centre + down(2 * std::numbers::pi * i / kDiscSides) * radius);
    return out;
}

}  // namespace

SweptRegion::SweptRegion(const MechanismView& at, OccupancyGrid covered, const std::vector<Perspective>& views)
    : room(std::move(covered)), at_(at) {
    const Vec2 axis = at.px(at.problem().cam ? at.problem().cam->centre : Vec2{});
    for (const Perspective& view : views)
        views_.push_back({view, at.seen(axis, &view) - at.seen(axis, &views.front())});
}

Vec2 SweptRegion::seen(const Seen& by, Vec2 flat, double depth) const {
    const Vec2 middle = at_.box.centre();
    return by.view.to_pixels({flat.x - middle.x, middle.y - flat.y, depth * at_.wide}) - by.shift;
}

// `outline`: convex.
void SweptRegion::add_body(std::span<const Vec2> outline, Depth depth, bool casts_shadow) {
    if (views_.empty()) return room.cover_convex(outline);
    std::vector<Vec2> body, shadow;
    for (const Seen& by : views_) {
        body.clear(), shadow.clear();
        for (const double z : {depth.back, depth.front}) {
            const double fall = (z - kWallDepth) * at_.wide / kLightNear.z;
            for (const Vec2 p : outline) {
                body.push_back(seen(by, p, z));
                if (casts_shadow) shadow.push_back(seen(by, p + Vec2{-kLightNear.x, kLightNear.y} * fall, kWallDepth));
            }
        }
        room.cover_convex(convex_hull(body));
        if (casts_shadow) room.cover_convex(convex_hull(shadow), kShadow);
    }
}

// In quadrilaterals of a few stations, from which the curve deviates by less than a pixel.
void SweptRegion::add_beam(const std::vector<Vec2>& face, const std::vector<Vec2>& back) {
    const std::size_t step = face.size() > 40 ? 4 : 1;
    for (std::size_t i = 0; i + 1 < face.size(); i += step) {
        const std::size_t next = std::min(i + step, face.size() - 1);
        add_body(std::array{face[i], face[next], back[next], back[i]}, kBeam);
    }
}

// Points of the edge move on straight lines between two frames.
void SweptRegion::add_motion(const std::vector<Vec2>& from, const std::vector<Vec2>& to) {
    const std::size_t step = from.size() > 40 ? 4 : 1;
    if (from.size() != to.size()) return;
    for (std::size_t i = 0; i + 1 < from.size(); i += step) {
        const std::size_t next = std::min(i + step, from.size() - 1);
        if (norm(from[next] - to[next]) > at_.look.depth * at_.look.camera.scale)
            add_body(std::array{from[i], from[next], to[next], to[i]}, kBeam);
    }
}

void SweptRegion::add_shape(const MechanismShape& shape) {
    add_beam(shape.face, shape.back);
    add_hub(shape.hinge, shape.hub);
    if (shape.disc) add_disc(shape.disc->centre, shape.disc->radius);
}

void SweptRegion::add_disc(Vec2 centre, double radius) {
    if (views_.empty()) return room.cover_disc(centre, radius);
    add_body(circle(centre, radius), {-kDiscDepth, kDiscDepth});
}

void SweptRegion::add_hub(Vec2 centre, double radius) {
    if (views_.empty()) return room.cover_disc(centre, radius);
    add_body(circle(centre, radius), {-kMountDepth, kHubDepth});
}

void SweptRegion::add_arrow(const ForceArrow& arrow) {
    const Vec2 foot = at_.px(arrow.foot), n{arrow.normal.x, -arrow.normal.y};
    const Vec2 side = Vec2{-n.y, n.x} * (8 * at_.marks), tip = foot + n * arrow_length(at_, arrow);
    add_body(std::array{foot + side, tip + side, tip - side, foot - side}, {0.5, 0.5}, false);
}

void SweptRegion::add_curve(const std::vector<Vec2>& curve) {
    if (views_.empty()) return room.cover(curve, 1);
    std::vector<Vec2> line(curve.size());
    for (const Seen& by : views_) {
        std::ranges::transform(curve, line.begin(), [&](Vec2 p) { return seen(by, p, 0.5); });
        room.cover(line, 1);
    }
}

// The bearing block of the solid view.
void SweptRegion::add_mount(Vec2 hinge, double hub) {
    const Vec2 half{1.5 * hub, 0}, foot{0, hub + 40 * at_.unit};
    add_body(std::array{hinge - half, hinge + half, hinge + half + foot, hinge - half + foot},
             {-kMountDepth, 0.5 * kMountDepth});
}

void SweptRegion::add_fixed() {
    for (const sim::Problem* p : at_.context.extent.problems) {
        const Vec2 o = at_.px({0, 0});
        const double hub = hub_radius(*p, at_.look.camera, at_.unit), half = support_half_width(hub, at_.marks);
        add_hub(o, hub + 4 * at_.unit);
        const double reach = support_reach(hub, at_.marks);
        if (views_.empty()) {
            room.cover(Box{o.x - half, o.y, 2 * half, reach}, 1);
            room.cover(Box{at_.box.x, o.y - 3 * at_.unit, at_.box.w, 6 * at_.unit}, 1);  // the horizontal
        } else {
            add_mount(o, hub);
        }
        if (p->cam && at_.problem().cam)
            add_disc(at_.px(p->cam->centre),
                     (p->cam->radius + p->cam->eccentricity) * at_.look.camera.scale + 4 * at_.unit);
    }
}

}  // namespace beamcam::render
