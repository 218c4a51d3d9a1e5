#include "render/gl/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/gl/soft_shadows.hpp"
#include "render/mechanism/mechanism.hpp"

namespace beamcam::render {

Materials materials(const Palette& palette) {
    const bool dark = palette.paper.g < 0.5;
    return {.cam = rgb(0x5B6675),
            .track = rgb(0x9AA5B3),
            .housing = rgb(dark ? 0x77818F : 0x2F3744),
            .pin = rgb(0xC9D1DC),
            .bracket = rgb(dark ? 0x4A5361 : 0x8C97A6)};
}

namespace {

constexpr double kClampDepth = 0.6, kBracketFront = -0.75;                       // as the depths of the header
constexpr double kShadow = 0.14, kOnFloor = 0.2, kContact = 0.4, kFloor = 0.06;  // opacities

// ---- the bodies --------------------------------------------------------------------------------

// Distance of a beam's stations [px]: chords of a radius of 300 px err by a tenth of a pixel.
constexpr double kStations = 16;

// Removes the part of the bar before the line through `at` across `along`, but not its last station.
void cut_root(Bar& bar, Vec2 at, Vec2 along) {
    const auto beyond = [&](std::size_t i) { return dot((bar.low[i] + bar.high[i]) * 0.5 - at, along); };
    std::size_t i = 0;
    while (i + 2 < bar.low.size() && beyond(i + 1) <= 0) ++i;
    const double share = std::clamp(beyond(i) / (beyond(i) - beyond(i + 1)), 0.0, 1.0);
    bar.low[i] = bar.low[i] * (1 - share) + bar.low[i + 1] * share;
    bar.high[i] = bar.high[i] * (1 - share) + bar.high[i + 1] * share;
    bar.colors[i] = mix(bar.colors[i], bar.colors[i + 1], share);
    const auto first = static_cast<std::ptrdiff_t>(i);
    bar.low.erase(bar.low.begin(), bar.low.begin() + first);
    bar.high.erase(bar.high.begin(), bar.high.begin() + first);
    bar.colors.erase(bar.colors.begin(), bar.colors.begin() + first);
}

// The mechanism in the panel's coordinates.
class Bodies {
  public:
    Bodies(const MechanismShape& shape, const Palette& palette, const Stage& stage, const Projection& view)
        : shape_(shape), stage_(stage), view_(view), palette_(palette), materials_(materials(palette)) {
        const std::size_t last = shape.face.size() - 1;
        for (std::size_t i = 0; i <= last; ++i) {
            if (i > 0 && i < last && norm(up(shape.face[i]) - bar_.low.back()) < kStations) continue;
            bar_.low.push_back(up(shape.face[i])), bar_.high.push_back(up(shape.back[i]));
            bar_.colors.push_back(shape.colors[i]);
        }
        const auto &low = bar_.low, &high = bar_.high;
        depth_ = norm(high[0] - low[0]), hinge_ = up(shape.hinge), floor_ = up({0, shape.floor}).y;
        along_ = low[1] - low[0] + high[1] - high[0];
        along_ = along_ * (1 / norm(along_));
        if (cross(along_, high[0] - low[0]) < 0) std::swap(bar_.low, bar_.high);
        if (shape.disc) axis_ = up(shape.disc->axis);
    }

    BodyMesh mesh() const;
    std::vector<ShadowVertex> shadows() const;

  private:
    Vec2 up(Vec2 p) const { return {p.x - stage_.middle.x, stage_.middle.y - p.y}; }
    // The camera is on the side of the line through `at` to which `way` points.
    bool seen_from(Vec2 way, Vec2 at) const {
        const Vec3 eye = view_.towards_camera({at.x, at.y, 0});
        return dot(way, Vec2{eye.x, eye.y}) > 0;
    }
    Prism round(Vec2 centre, double radius, double back, double front, double chamfer) const;
    Prism cam() const;
    void add_bracket(BodyMesh& mesh, const MechanismShape::Bracket& bracket) const;
    void add_cam(BodyMesh& mesh) const;
    void add_hub(BodyMesh& mesh) const;
    void add_beam(BodyMesh& mesh, bool after_hub) const;
    void wall_shadows(SoftShadows& out) const;
    void floor_shadows(SoftShadows& out) const;

    const MechanismShape& shape_;
    const Stage& stage_;
    const Projection& view_;
    const Palette& palette_;
    Materials materials_;
    Bar bar_;
    Vec2 hinge_, along_, axis_;  // along the root of the beam; of the cam
    double depth_ = 0, floor_ = 0;
};

Prism Bodies::round(Vec2 centre, double radius, double back, double front, double chamfer) const {
    Prism p = cylinder(centre, radius);
    p.back = back, p.front = front, p.chamfer = std::min(chamfer * stage_.unit, 0.3 * radius);
    return p;
}

Prism Bodies::cam() const {
    const DiscShape& d = *shape_.disc;
    Prism p;
    if (d.outline.empty()) p = cylinder(up(d.centre), d.radius);
    for (std::size_t i = 0; i < d.outline.size(); ++i) {
        p.outline.push_back(up(d.outline[i]));
        p.outward.push_back({d.outward[i].x, -d.outward[i].y});
        p.axis = axis_, p.turned = true;
    }
    p.back = -kDiscDepth * stage_.wide, p.front = -p.back;
    p.chamfer = std::min({3 * stage_.unit, 0.05 * d.radius, 0.5 * d.sharpest});
    return p;
}

// Behind the moving bodies: a pillar on a plate. Two that overlap have no chamfers, so that they look like one.
void Bodies::add_bracket(BodyMesh& mesh, const MechanismShape::Bracket& bracket) const {
    const Vec2 axis = up(bracket.shaft);
    const double u = stage_.unit, top = bracket.top, foot = bracket.foot, half = foot - 8 * u, plate = floor_ + 8 * u;
    const bool joined = std::ranges::any_of(shape_.brackets, [&](const MechanismShape::Bracket& other) {
        return &other != &bracket && std::abs(other.shaft.x - bracket.shaft.x) < other.foot + foot;
    });
    Prism base = block(std::array{Vec2{axis.x - foot, floor_}, Vec2{axis.x + foot, floor_}, Vec2{axis.x + foot, plate},
                                  Vec2{axis.x - foot, plate}});
    Prism pillar = block(std::array{Vec2{axis.x - half, plate}, Vec2{axis.x + half, plate}, Vec2{axis.x + top, axis.y},
                                    Vec2{axis.x - top, axis.y}});
    pillar.back = base.back = -kMountDepth * stage_.wide, pillar.front = base.front = kBracketFront * stage_.wide;
    pillar.chamfer = base.chamfer = joined ? 0 : 2 * u;
    const bool below = seen_from({0, -1}, {axis.x, plate});
    if (below) mesh.add(pillar, materials_.bracket);
    mesh.add(base, mix(materials_.bracket, materials_.housing, 0.5));
    if (!below) mesh.add(pillar, materials_.bracket);
    mesh.add(round(axis, 1.15 * top, pillar.front, -kHubDepth * stage_.wide, 2), materials_.bracket);
}

// The track, on which the trace of the contact is drawn, is lighter than the face within it.
void Bodies::add_cam(BodyMesh& mesh) const {
    const DiscShape& d = *shape_.disc;
    const double u = stage_.unit;
    Prism track = cam(), web = track;
    const double rim = std::min({11 * u, 0.16 * d.radius, 0.5 * d.sharpest});
    for (std::size_t i = 0; i < web.outline.size(); ++i) web.outline[i] = web.outline[i] - web.outward[i] * rim;
    track.band = rim + 2, web.back = web.front, web.chamfer = std::min(2 * u, track.chamfer);
    const Prism bearing = round(axis_, d.bore, track.front, track.front + 4 * u, 2);
    mesh.add(round(axis_, 1.3 * d.bore, -kHubDepth * stage_.wide, track.back, 0), materials_.housing);
    mesh.add(track, materials_.track);
    mesh.add(web, materials_.cam);
    mesh.add(round(up(d.mark), d.mark_radius, track.front, track.front, 0), mix(materials_.cam, rgb(0), 0.5));
    mesh.add(bearing, materials_.housing);
    mesh.add(round(axis_, 0.5 * d.bore, bearing.front, bearing.front + 3 * u, 1.5), materials_.pin);
}

void Bodies::add_hub(BodyMesh& mesh) const {
    mesh.add(round(hinge_, shape_.hub, -kHubDepth * stage_.wide, kClampDepth * stage_.wide, 0), materials_.housing);
}

// A block clamps the root of the beam. Where they are added after the hub, it is not over them, but they end at it.
void Bodies::add_beam(BodyMesh& mesh, bool after_hub) const {
    const double u = stage_.unit, half = 0.5 * depth_ + std::max(0.12 * depth_, 2 * u);
    const Vec2 across = sim::perp(along_), root = (bar_.low[0] + bar_.high[0]) * 0.5;
    const double off = dot(root - hinge_, across), end = shape_.hub + std::max(0.55 * depth_, 6 * u);
    const double start = after_hub ? 0.75 * shape_.hub : 0;
    const Vec2 a = hinge_ + across * (off - half), b = hinge_ + across * (off + half);
    Prism clamp = block(std::array{a + along_ * start, a + along_ * end, b + along_ * end, b + along_ * start});
    clamp.back = -kClampDepth * stage_.wide, clamp.front = -clamp.back,
    clamp.chamfer = std::min(2.5 * u, 0.15 * depth_);
    Bar bar = bar_;
    bar.half = 0.5 * stage_.wide, bar.chamfer = 0.04 * depth_, bar.lean = 0.1;
    const bool from_tip = seen_from(along_, hinge_ + along_ * end);
    if (from_tip) {
        mesh.add(clamp, materials_.housing);
        cut_root(bar, hinge_ + along_ * end, along_);
    }
    mesh.add(bar);
    if (!from_tip) mesh.add(clamp, materials_.housing);
}

// Bodies that a plane separates are added in the order in which the camera sees them.
BodyMesh Bodies::mesh() const {
    BodyMesh mesh(view_);
    const double front = kHubDepth * stage_.wide;
    const bool beam_nearer =
        !shape_.touch || seen_from({shape_.touch->normal.x, -shape_.touch->normal.y}, up(shape_.touch->at));
    const bool beam_side = seen_from(along_, hinge_ + along_ * shape_.hub);
    const bool hub_nearer = seen_from(hinge_ - axis_, (hinge_ + axis_) * 0.5);
    const std::size_t brackets = shape_.brackets.size();
    for (std::size_t i = 0; i < brackets; ++i) add_bracket(mesh, shape_.brackets[hub_nearer ? brackets - 1 - i : i]);
    if (beam_side) add_hub(mesh);
    if (shape_.disc && beam_nearer) add_cam(mesh);
    add_beam(mesh, beam_side);
    if (!beam_side) add_hub(mesh);
    if (shape_.disc && !beam_nearer) add_cam(mesh);
    mesh.add(round(hinge_, shape_.hub, kClampDepth * stage_.wide, front, 3), materials_.housing);
    mesh.add(round(hinge_, shape_.pin, front, front + 4 * stage_.unit, 1.5), materials_.pin);
    return mesh;
}

// The light is at the upper left. The wall is as near as the beam is thin, whose shadow would look like another beam.
void Bodies::wall_shadows(SoftShadows& out) const {
    const double u = std::min(stage_.unit, depth_ / 14), soft = 15 * u;
    const Vec2 fall{9 * u, -14 * u};
    std::vector<SoftShadows::Station> beam;
    for (std::size_t i = 0; i < bar_.low.size(); ++i) beam.push_back({bar_.low[i] + fall, bar_.high[i] + fall, soft});
    out.ribbon(beam, kShadow, 0);
    const Prism hub = cylinder(hinge_ + fall, shape_.hub);
    out.polygon(hub.outline, hub.outward, soft, kShadow);
    if (!shape_.disc) return;
    Prism body = cam();
    for (Vec2& p : body.outline) p += fall;
    out.polygon(body.outline, body.outward, soft, kShadow);
}

// The light is above, a little to the left and in front; penumbrae grow with the height above the floor.
void Bodies::floor_shadows(SoftShadows& out) const {
    const double wide = stage_.wide, u = stage_.unit, half = wide / 2;
    const auto soft = [&](double height) { return 5 * u + 0.16 * height; };
    const auto fall = [&](double height) { return Vec2{0.2 * height, -0.1 * height}; };
    std::vector<SoftShadows::Station> beam;
    double length = 0;
    for (std::size_t i = 0; i < bar_.low.size(); ++i) {
        if (i > 0) length += norm(bar_.low[i] - bar_.low[i - 1]);
        const Vec2 p = (bar_.low[i] + bar_.high[i]) * 0.5;
        const double height = std::max(p.y - out.level, 0.0);
        const Vec2 at = Vec2{p.x, 0} + fall(height);
        beam.push_back({at - Vec2{0, half}, at + Vec2{0, half}, soft(height)});
    }
    out.ribbon(beam, kOnFloor, 0);
    for (const MechanismShape::Bracket& each : shape_.brackets) {
        const double x = up(each.shaft).x;
        out.rectangle({x - each.foot, -kMountDepth * wide}, {x + each.foot, kBracketFront * wide}, 16 * u, kContact);
    }
    const auto below = [&](const Prism& body, double depth) {
        Bounds seen;
        for (const Vec2 p : body.outline) seen.add(p);
        const double height = std::max((seen.y0 + seen.y1) / 2 - out.level, 0.0);
        const Vec2 at = fall(height), deep{0, depth * wide};
        out.rectangle(Vec2{seen.x0, 0} + at - deep, Vec2{seen.x1, 0} + at + deep, soft(height), kOnFloor);
    };
    below(cylinder(hinge_, shape_.hub), kHubDepth);
    if (shape_.disc) below(cam(), kDiscDepth);
    // The floor itself, as far as the beam reaches to the middle of the panel.
    const double edge = 3 * wide, tip = hinge_.x + (hinge_.x <= 0 ? length : -length);
    out.rectangle({std::min(hinge_.x, tip) - edge / 2, -3 * wide}, {std::max(hinge_.x, tip) + edge / 2, 2.5 * wide},
                  edge, kFloor, palette_.paper.g < 0.5 ? 1 : 0.2);
}

std::vector<ShadowVertex> Bodies::shadows() const {
    SoftShadows out{view_, stage_.ground, stage_.ground == Ground::wall ? -kMountDepth * stage_.wide : floor_};
    if (stage_.ground == Ground::wall) wall_shadows(out);
    if (stage_.ground == Ground::floor) floor_shadows(out);
    return out.corners;
}

}  // namespace

BodyScene body_scene(const MechanismShape& shape, const Palette& palette, const Stage& stage, const Projection& view) {
    constexpr double kEye = 1.6;  // of the picture's size: highlights move over a body as if seen from there
    const Bodies bodies(shape, palette, stage, view);
    BodyMesh mesh = bodies.mesh();
    BodyScene scene{std::move(mesh.vertices), std::move(mesh.corners), bodies.shadows()};
    const double away = std::min(view.distance, kEye * std::max(stage.box.w, stage.box.h));
    scene.eye = {away * view.axes[2].x, away * view.axes[2].y, away * view.axes[2].z};
    scene.seen = DirtyTiles(static_cast<int>(stage.box.w), static_cast<int>(stage.box.h));
    const auto add = [&](const auto& a, const auto& b, const auto& c) {
        Bounds triangle;
        for (const auto* v : {&a, &b, &c}) triangle.add({v->pixel[0], v->pixel[1]}, 1);
        scene.seen.add(triangle.box());
    };
    const auto body = [&](std::size_t i) -> const BodyVertex& { return scene.vertices[scene.corners[i]]; };
    for (std::size_t i = 0; i < scene.corners.size(); i += 3) add(body(i), body(i + 1), body(i + 2));
    for (std::size_t i = 0; i < scene.shadows.size(); i += 3)
        add(scene.shadows[i], scene.shadows[i + 1], scene.shadows[i + 2]);
    return scene;
}

}  // namespace beamcam::render
