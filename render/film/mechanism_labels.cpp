#include "render/film/mechanism_labels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/film/mechanism_marks.hpp"
#include "render/plot/ticks.hpp"

namespace beamcam::render {
namespace {

using std::numbers::pi;
constexpr double kLabelFade = 0.2;           // duration of fading a label without a free place [s]
constexpr double kFarthestLetter = 65;       // largest distance of θ from its arc [design px of the letter]
constexpr double kLowestLetter = 1.2;        // largest angle of θ beyond the horizontal [rad]
constexpr std::size_t kMeasuredPushes = 60;  // number of forces whose texts are measured to find the widest label

Box about(Vec2 middle, Vec2 size) { return {middle.x - size.x / 2, middle.y - size.y / 2, size.x, size.y}; }

}  // namespace

double least_letter(const MechanismView& at) {
    constexpr double kOfTicks = 0.75;  // a single letter is recognized more easily than a number
    return std::max(kReadable, kOfTicks * at.context.tick);
}

double label_size(const MechanismView& at) { return std::max(21 * at.unit, at.context.tick); }

double angle_letter(const MechanismView& at) { return std::max({at.marks, at.context.tick / 21, kReadable / 21}); }

std::string speed_label(const MechanismView& at) {
    return "$ω$\u2009=\u2009" +
           turning_speed(at.problem().cam->speed, at.context.setup->units.rpm, at.context.setup->speed_decimals);
}

std::string force_label(const MechanismView& at, const ForceArrow& arrow) {
    const std::string peak_of = arrow.is_peak ? at.context.translate("peak") + "\u00A0" : std::string();
    return peak_of + "$F$\u2009=\u2009" + reading(arrow.force, "N");
}

// ---- the swept region --------------------------------------------------------------------------

SweptRegion::SweptRegion(const MechanismView& at, const Box& area, double cell) : room(area, cell), at_(at) {
    const View& view = at.context.setup->view;
    if (view.style != Style::solid) return;
    for (const double way : {-1.0, 0.0, 1.0}) {
        const auto seen = Perspective::looking({}, 2.4 * std::max(at.box.w, at.box.h), 1,
                                               view.shot.yaw + way * view.swing, view.shot.pitch);
        const Vec2 through = seen.to_pixels({0, 0, -0.5 * at.wide}) - seen.to_pixels({0, 0, 0.5 * at.wide});
        const int steps = 1 + static_cast<int>(norm(through) / (2 * cell));
        for (int i = 1; i <= steps; ++i) shifts_.push_back(through * (double(i) / steps));
        if (view.swing == 0) break;
    }
}

// In quadrilaterals of a few stations, from which the curve deviates by less than a pixel.
void SweptRegion::add_beam(const std::vector<Vec2>& face, const std::vector<Vec2>& back) {
    const std::size_t step = face.size() > 40 ? 4 : 1;
    for (std::size_t i = 0; i + 1 < face.size(); i += step) {
        const std::size_t next = std::min(i + step, face.size() - 1);
        add_piece({face[i], face[next], back[next], back[i]});
    }
}

// Points of the edge move on straight lines between two frames.
void SweptRegion::add_motion(const std::vector<Vec2>& from, const std::vector<Vec2>& to) {
    const std::size_t step = from.size() > 40 ? 4 : 1;
    if (from.size() != to.size()) return;
    for (std::size_t i = 0; i + 1 < from.size(); i += step) {
        const std::size_t next = std::min(i + step, from.size() - 1);
        if (norm(from[next] - to[next]) > at_.look.depth * at_.look.camera.scale)
            add_piece({from[i], from[next], to[next], to[i]});
    }
}

void SweptRegion::add_piece(const std::array<Vec2, 4>& corners) {
    room.cover_convex(corners);
    for (const Vec2 by : shifts_)
        room.cover_convex(std::array{corners[0] + by, corners[1] + by, corners[2] + by, corners[3] + by});
}

void SweptRegion::add_disc(Vec2 centre, double radius) {
    room.cover_disc(centre, radius);
    for (const Vec2 by : shifts_) room.cover_disc(centre + by, radius);
}

void SweptRegion::add_arrow(const ForceArrow& arrow) {
    const Vec2 foot = at_.px(arrow.foot), n{arrow.normal.x, -arrow.normal.y};
    const Vec2 side = Vec2{-n.y, n.x} * (8 * at_.marks), tip = foot + n * arrow_length(at_, arrow);
    room.cover_convex(std::array{foot + side, tip + side, tip - side, foot - side});
}

void SweptRegion::add_fixed() {
    for (const sim::Problem* p : at_.context.extent.problems) {
        const Vec2 o = at_.px({0, 0});
        const double hub = hub_radius(*p, at_.look.camera, at_.unit), half = support_half_width(hub, at_.marks);
        add_disc(o, hub + 4 * at_.unit);
        const double reach = support_reach(hub, at_.marks);
        room.cover(Box{o.x - half, o.y, 2 * half, reach}, 1);
        for (const Vec2 by : shifts_)
            for (const double far : {1.0, 2.0, 3.0})  // the mount is deeper than the beam
                room.cover(Box{o.x - half + far * by.x, o.y + far * by.y, 2 * half, reach}, 1);
        room.cover(Box{at_.box.x, o.y - 3 * at_.unit, at_.box.w, 6 * at_.unit}, 1);  // the horizontal
        if (p->cam && at_.problem().cam)
            add_disc(at_.px(p->cam->centre),
                     (p->cam->radius + p->cam->eccentricity) * at_.look.camera.scale + 4 * at_.unit);
    }
}

// ---- places ------------------------------------------------------------------------------------

namespace {

class LabelPlacer {
  public:
    LabelPlacer(const MechanismView& view, const LabelNeeds& all) : at(view), u(view.unit), needs(all) {}

    // Radius at which the letter fits beside the arc, limited by the cam and the panel.
    double arc_radius() const {
        const double letter = angle_letter(at), depth = at.look.depth * at.look.camera.scale;
        const double preferred = 17 * letter + (28 * letter + depth / 2) / std::max(least_angle(), 1e-3);
        return std::min(std::clamp(preferred, 92 * at.marks, 150 * at.marks), needs.arc_room);
    }

    // The arc in all positions of the beam; empty without an arc.
    std::vector<Vec2> arc(double radius) const {
        std::vector<Vec2> out;
        const double from = std::min(needs.angles.low, 0.0), to = std::max(needs.angles.high, 0.0);
        for (int i = 0; i <= 64 && radius >= at.hub() + 22 * at.marks; ++i)
            out.push_back(at.px({0, 0}) + down(from + (to - from) * i / 64) * radius);
        return out;
    }

    // The letter goes to the middle of the sector between the horizontal and the nearest position of the beam or, if
    // that is too small, to the other side of the horizontal, beside the arc. None if it has room in neither.
    std::optional<LabelPlace> angle(const OccupancyGrid& room, double radius) const {
        const double letter = angle_letter(at), side = -needs.angles.low > needs.angles.high ? -1 : 1;
        if (arc(radius).empty() || std::max(-needs.angles.low, needs.angles.high) < kLeastArc) return std::nullopt;
        const Vec2 o = at.px({0, 0}), size{13 * letter, 17 * letter};
        const Vec2 inside = o + down(side * 0.5 * least_angle()) * (radius - 17 * letter),
                   beyond = o + Vec2{radius, side * 16 * letter};
        for (const Vec2 middle : {inside, beyond}) {
            if (middle == inside && radius <= at.hub() + 34 * letter) continue;
            LabelPlace out = place(room, about(middle, size), o, 3 * u);
            const Vec2 way = at.px(out.middle) - o;
            const double turned = side * std::atan2(-way.y, way.x);
            const double far = middle == inside ? std::abs(norm(way) - radius) : norm(way - Vec2{radius, 0});
            if (far > kFarthestLetter * letter || turned < -kLowestLetter || turned > least_angle()) continue;
            out.base = at.look.camera.to_world(o + way * (radius / norm(way)));
            return out;
        }
        return std::nullopt;
    }

    // The label is beside its arrow; the arrow goes to the first side with space for both.
    LabelPlace speed(const OccupancyGrid& room, double width, double& way) const {
        double least = std::numeric_limits<double>::infinity();
        for (const double each : {-0.30 * pi, -0.70 * pi, 0.30 * pi, 0.70 * pi, -0.5 * pi, 0.5 * pi, 0.0, pi}) {
            double cost = room.covered(speed_box(each, width));
            for_each_arrow_box(each, [&](const Box& box) { cost += room.covered(box); });
            if (cost < least) least = cost, way = each;
        }
        OccupancyGrid taken = room;
        for_each_arrow_box(way, [&](const Box& box) { taken.cover(box, 1); });
        const double edge = speed_radius(at) - speed_gap(at);
        return place(taken, speed_box(way, width), at.px(at.problem().cam->centre) + down(way) * edge);
    }

    template <class Visit>
    void for_each_arrow_box(double way, const Visit& visit) const {
        if (at.problem().cam->speed == 0) return;
        const double radius = speed_radius(at), half = speed_span(at) / 2;
        for (int i = -2; i <= 2; ++i)
            visit(about(at.px(at.problem().cam->centre) + down(way + half * i / 2) * radius, Vec2{8, 8} * u));
    }

    // Beside the tip of the longest arrow, clear of the beam.
    LabelPlace force(const OccupancyGrid& room, Canvas& canvas) const {
        const ForceArrow& most = *std::ranges::max_element(needs.arrows, {}, &ForceArrow::force);
        double width = 0;
        const auto measure = [&](const ForceArrow& arrow) {
            width = std::max(width, canvas.measure(force_label(at, arrow), force_style(at)).w);
        };
        measure(most);
        const std::size_t step = 1 + needs.arrows.size() / kMeasuredPushes;
        for (std::size_t i = 0; i < needs.arrows.size(); i += step) measure(needs.arrows[i]);
        const Vec2 n{most.normal.x, -most.normal.y};
        const double clear = force_label_distance(arrow_length(at, most), at.look.depth * at.look.camera.scale, u);
        const Vec2 tip = at.px(most.foot) + n * clear;
        const bool right = n.x > 0.5;  // on its left is the beam
        const double gap = 14 * u + shrunk(width), size = label_size(at);
        return place(room, {tip.x + (right ? gap : -gap - width), tip.y - size * 2 / 3, width, size * 4 / 3},
                     at.px(most.foot));
    }

  private:
    double least_angle() const { return std::max({needs.angles.low, -needs.angles.high, 0.0}); }

    Box speed_box(double way, double width) const {
        const Vec2 axis = at.px(at.problem().cam->centre);
        const bool right = std::cos(way) > 0;
        const Vec2 to = axis + down(way + (right ? 0.04 : -0.04) * pi) * (speed_radius(at) + 16 * u);
        const double base = std::min(to.y + 12 * u, at.box.bottom() - 34 * u);  // above the scale bar
        const double gap = 8 * u + shrunk(width);
        const double size = label_size(at);
        return {to.x + (right ? gap : -gap - width), base - 0.844 * size, width, 1.048 * size};
    }

    // Labels move towards their arrows in the solid view, where the mechanism is smaller than in the flat view.
    double shrunk(double width) const { return at.context.setup->view.style == Style::solid ? 0.07 * width : 0; }

    LabelPlace place(const OccupancyGrid& room, const Box& preferred, Vec2 base, double clear = 0) const {
        const Box found = room.nearest_free(preferred.inset(-u - clear - shrunk(preferred.w)));
        const Camera& camera = at.look.camera;
        LabelPlace out{camera.to_world(found.centre()), {preferred.w, preferred.h}, camera.to_world(base), {}};
        if (room.covered(found) > 0) fade_where_met(out);
        return out;
    }

    void fade_where_met(LabelPlace& label) const {
        const Box box = at.label_box(label, nullptr);
        std::vector<int> met;
        for (int k = 0; k < at.context.frames(); ++k) {
            SweptRegion now(at, box, 4 * u);
            const sim::Pose pose = at.context.pose(at.member, k);
            const DrawnBeam beam = at.drawn(at.member, pose);
            const MechanismShape shape = mechanism_shape(at.problem(), pose, beam, at.look, at.palette);
            now.add_beam(shape.face, shape.back);
            if (now.room.covered(box.inset(0.01)) > 0) met.push_back(k);
        }
        if (met.empty()) return;
        const double fade = kLabelFade * at.context.setup->fps;
        for (int k = 0; k < at.context.frames(); ++k) {
            const auto after = std::ranges::lower_bound(met, k);
            int far = at.context.frames();
            if (after != met.end()) far = *after - k;
            if (after != met.begin()) far = std::min(far, k - *std::prev(after));
            label.opacity.push_back(static_cast<float>(std::min(1.0, far / (1 + fade))));
        }
    }

    const MechanismView& at;
    const double u;
    const LabelNeeds& needs;
};

}  // namespace

MechanismLabels place_labels(const MechanismView& at, const LabelNeeds& needs, SweptRegion& swept,
                             SweptRegion& in_contact) {
    MechanismLabels out;
    const LabelPlacer placer(at, needs);
    out.arc_radius = placer.arc_radius();
    if (!at.labelled()) return out;
    Image scratch(1, 1);
    Canvas canvas(scratch, *at.context.fonts);
    const auto take = [&](const LabelPlace& label) {
        for (SweptRegion* each : {&swept, &in_contact}) each->room.cover(at.label_box(label, nullptr), 1);
    };
    if (at.context.setup->view.style != Style::solid)
        for (SweptRegion* each : {&swept, &in_contact}) each->room.cover(placer.arc(out.arc_radius), 1);
    if (at.problem().cam) {
        out.speed =
            placer.speed(swept.room, canvas.measure(speed_label(at), {.size = label_size(at)}).w, out.speed_way);
        take(*out.speed);
        for (SweptRegion* each : {&swept, &in_contact})
            placer.for_each_arrow_box(out.speed_way, [&](const Box& box) { each->room.cover(box, 1); });
    }
    if (at.context.setup->view.style != Style::solid) out.angle = placer.angle(swept.room, out.arc_radius);
    if (out.angle) take(*out.angle);
    if (!needs.arrows.empty()) {
        out.force = placer.force(in_contact.room, canvas);
        take(*out.force);
    }
    return out;
}

}  // namespace beamcam::render
