#include "render/film/mechanism_labels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "render/film/label_visibility.hpp"
#include "render/film/mechanism_marks.hpp"
#include "render/film/swept_region.hpp"

namespace beamcam::render {
namespace {

using std::numbers::pi;
constexpr double kText = 4;             // weight of labels, over which names are not readable; of bodies 1
constexpr double kFarthestLetter = 65;  // largest distance of θ from its arc [design px of the letter]
constexpr double kLowestLetter = 1.2;   // largest angle of θ beyond the horizontal [rad]

Box about(Vec2 middle, Vec2 size) { return {middle.x - size.x / 2, middle.y - size.y / 2, size.x, size.y}; }

}  // namespace

double least_letter(const MechanismView& at) {
    constexpr double kOfTicks = 0.75;  // a single letter is recognized more easily than a number
    return std::max(kReadable, kOfTicks * at.context.tick);
}

double label_size(const MechanismView& at) { return std::max(21 * at.unit, at.context.tick); }

double angle_letter(const MechanismView& at) { return std::max({at.marks, at.context.tick / 21, kReadable / 21}); }

// ---- places ------------------------------------------------------------------------------------

namespace {

class LabelPlacer {
  public:
    LabelPlacer(const MechanismView& home, const MechanismCameras& seen_by, const LabelNeeds& all)
        : at(home), cameras(seen_by), u(home.unit), needs(all), view(seen_by.usual()) {}

    // Radius at which the letter fits beside the arc, limited by the panel. An arc that has no room between hub and cam
    // is beyond the cam or, if the beam is too short for that, behind the disc; so is that of the solid view, whose
    // bearing takes that room.
    double arc_radius() const {
        const double letter = angle_letter(at), depth = at.look.depth * at.look.camera.scale;
        double preferred = std::clamp(17 * letter + (28 * letter + depth / 2) / std::max(least_angle(), 1e-3),
                                      92 * at.marks, 150 * at.marks);
        const double hub = view ? 1.5 * at.hub() + kMountDepth * at.wide : at.hub();  // with its bearing
        if (preferred < hub + 34 * letter) preferred = hub + 50 * letter;
        const std::optional<sim::Cam>& cam = at.problem().cam;
        if (!cam) return std::min(preferred, needs.arc_room);
        const double scale = at.look.camera.scale, before = arc_before_cam(*cam) * scale;
        if (before >= least_arc() && !view) return std::min({preferred, before, needs.arc_room});
        const double aside = view ? 2 * kDiscDepth * at.wide + 40 * letter : 12 * u;  // of the disc and the letter
        const double beyond =
            std::max(preferred, (norm(cam->centre) + cam->radius + cam->eccentricity) * scale + aside);
        const double reach = 0.8 * (at.problem().hub.radius + at.problem().beam.length) * scale;
        return std::min(beyond <= reach ? beyond : preferred, needs.arc_room);
    }

    // The arc in all positions of the beam; empty without an arc.
    std::vector<Vec2> arc(double radius) const {
        std::vector<Vec2> out;
        const double from = std::min(needs.angles.low, 0.0), to = std::max(needs.angles.high, 0.0);
        for (int i = 0; i <= 64 && radius >= least_arc(); ++i)
            out.push_back(on(at.px({0, 0}) + down(from + (to - from) * i / 64) * radius));
        return out;
    }

    // The letter goes to the middle of the sector between the horizontal and the nearest position of the beam or, if
    // that is too small, to the other side of the horizontal, beside the arc. If it has room in neither, it goes where
    // it is visible longest.
    std::optional<LabelPlace> angle(const OccupancyGrid& room, double radius) const {
        const double letter = angle_letter(at);
        const double widest = std::max(-needs.angles.low, needs.angles.high);
        const double under_beam = 0.5 * at.look.depth * at.look.camera.scale + 3 * u;  // an arc that is never seen
        if (arc(radius).empty() || widest < kLeastArc || widest * radius < under_beam) return std::nullopt;
        const Vec2 o = at.px({0, 0}), size{13 * letter, 17 * letter};
        const Vec2 inside = o + down(side() * 0.5 * least_angle()) * (radius - 17 * letter),
                   beyond = o + Vec2{radius, side() * 16 * letter};
        for (const Vec2 middle : {inside, beyond}) {
            if (middle == inside && radius <= at.hub() + 34 * letter) continue;
            const LabelPlace out = place(room, about(on(middle), size), o, 3 * u);
            const Vec2 way = at.px(out.base) + out.offset - (on(middle) - on(o)) + (middle - o) - o;
            const double turned = side() * std::atan2(-way.y, way.x);
            const double far = middle == inside ? std::abs(norm(way) - radius) : norm(way - Vec2{radius, 0});
            if (far <= kFarthestLetter * letter && turned >= -kLowestLetter && turned <= least_angle() &&
                room.covered(box(out)) == 0)
                return beside_arc(way, size, radius, room);
        }
        return beside_arc(longest_visible(beyond - o, size, radius, widest), size, radius, room);
    }

    // The label is beside its arrow; the arrow goes to the first side with space for both, or else to the direction
    // with the least that is covered.
    LabelPlace speed(const OccupancyGrid& room, double width, double& way) const {
        double least = std::numeric_limits<double>::infinity();
        std::vector<double> ways{-0.30 * pi, -0.70 * pi, 0.30 * pi, 0.70 * pi, -0.5 * pi, 0.5 * pi, 0.0, pi};
        const std::size_t usual_ways = ways.size();
        for (int i = 1; i < 12; ++i)
            for (const double turn : {-i * pi / 12, i * pi / 12}) ways.push_back(ways.front() + turn);
        constexpr double kShadows = 0.1;  // a cost that shadows alone may have
        for (std::size_t i = 0; i < ways.size() && (i < usual_ways || least > kShadows); ++i) {
            const double each = ways[i];
            double cost = room.covered(speed_box(each, width));
            for (const Box& box : arrow_boxes(each)) cost += room.covered(box);
            if (cost < least) least = cost, way = each;
        }
        OccupancyGrid taken = room;
        for (const Box& box : arrow_boxes(way)) taken.cover(box.inset(-3 * u), 1);
        const double edge = speed_radius(at) - speed_gap(at);
        LabelPlace out = place(taken, speed_box(way, width), axis() + down(way) * edge);
        if (cameras.near())
            shift_clear(out, cameras, [&](const SeenFrame& now) -> std::optional<WantedPlace> {
                const Vec2 base = now.at.seen(now.at.px(out.base), now.by());
                if (!now.at.shows(base)) return std::nullopt;
                return WantedPlace{base, about(base + out.offset, out.size), arrow_boxes(way, now.at, now.by())};
            });
        else
            fade_where_met(out, cameras, taken);
        return out;
    }

    Box box(const LabelPlace& label) const { return at.label_box(label, usual()); }

    std::vector<Box> arrow_boxes(double way) const { return arrow_boxes(way, at, usual()); }
    static std::vector<Box> arrow_boxes(double way, const MechanismView& at, const Perspective* by) {
        std::vector<Box> out;
        const sim::Cam& cam = *at.problem().cam;
        const double radius = speed_radius(at), half = speed_span(at) / 2;
        for (int i = -2; i <= 2 && cam.speed != 0; ++i)
            out.push_back(
                about(at.seen(at.px(cam.centre) + down(way + half * i / 2) * radius, by), Vec2{8, 8} * at.unit));
        return out;
    }

  private:
    // A smaller arc is not drawn [px].
    double least_arc() const { return at.hub() + 22 * at.marks; }

    double side() const { return -needs.angles.low > needs.angles.high ? -1 : 1; }

    // `way`: from the hinge to the middle of the letter, which keeps its distance from the arc [px].
    LabelPlace beside_arc(Vec2 way, Vec2 size, double radius, const OccupancyGrid& room) const {
        const Vec2 on_arc = way * (radius / norm(way));
        LabelPlace out{at.look.camera.to_world(at.px({0, 0}) + on_arc), way - on_arc, size, {}, {}};
        if (cameras.near())
            shift_clear(out, cameras, [&](const SeenFrame& now) { return beside_arc_at(now, out, radius); });
        else
            fade_where_met(out, cameras, room);
        return out;
    }

    // Before a moving camera the letter is in the middle of the sector while its usual place is out of view.
    std::optional<WantedPlace> beside_arc_at(const SeenFrame& now, const LabelPlace& label, double radius) const {
        const auto seen = [&](Vec2 flat) { return now.at.seen(flat, now.by()); };
        const std::vector<Vec2> arc = angle_arc(now.at, radius, now.at.context.pose(now.at.member, now.frame));
        WantedPlace out{seen(now.at.px(label.base)), {}, {}};
        out.box = about(out.base + label.offset, label.size);
        if (!now.at.shows(out.base)) {
            const Vec2 middle = arc[arc.size() / 2], way = now.at.px({0, 0}) - middle;
            if (!now.at.shows(seen(middle))) return std::nullopt;
            out.box = about(seen(middle + way * (17 * angle_letter(at) / norm(way))), label.size);
        }
        for (const Vec2 p : arc) out.owner.push_back(about(seen(p), Vec2{2, 2} * u));
        return out;
    }

    // Of the places beside the arc, `beyond` its start first, the one that is beside what is drawn of it and visible
    // longest.
    Vec2 longest_visible(Vec2 beyond, Vec2 size, double radius, double widest) const {
        constexpr int kPlaces = 24;
        std::vector<std::pair<double, Vec2>> places{{0, beyond}};
        for (int i = 0; i < kPlaces; ++i)
            for (const double off : {-17.0, 17.0}) {
                const double angle = widest * (i + 0.5) / kPlaces;
                places.emplace_back(angle, down(side() * angle) * (radius + off * angle_letter(at)));
            }
        Vec2 best = beyond;
        double most = 0;
        for (const auto& [angle, way] : places) {
            const Box letter = about(at.px({0, 0}) + way, size);
            if (!at.box.contains(letter)) continue;
            const double visible = frames_visible(letter, cameras, [&, least = angle](const sim::Pose& pose) {
                return side() * drawn_angle(pose) >= least;
            });
            if (visible > most) best = way, most = visible;
        }
        return best;
    }

    double least_angle() const { return std::max({needs.angles.low, -needs.angles.high, 0.0}); }

    Box speed_box(double way, double width) const {
        const bool right = std::cos(way) > 0;
        const Vec2 to = on(axis() + down(way + (right ? 0.04 : -0.04) * pi) * (speed_radius(at) + 16 * u));
        const double base = std::min(to.y + 12 * u, at.box.bottom() - 34 * u);  // above the scale bar
        const double gap = 8 * u, size = label_size(at);
        return {to.x + (right ? gap : -gap - width), base - 0.844 * size, width, 1.048 * size};
    }

    Vec2 axis() const { return at.px(at.problem().cam->centre); }
    const Perspective* usual() const { return view ? &*view : nullptr; }
    Vec2 on(Vec2 flat) const { return at.seen(flat, usual()); }

    LabelPlace place(const OccupancyGrid& room, const Box& preferred, Vec2 base, double clear = 0) const {
        return placed_near(at, usual(), room, preferred, base, clear);
    }

    const MechanismView& at;
    const MechanismCameras& cameras;
    const double u;
    const LabelNeeds& needs;
    std::optional<Perspective> view;  // the usual one of the solid view
};

}  // namespace

double arc_before_cam(const sim::Cam& cam) { return 0.86 * (norm(cam.centre) - (cam.radius + cam.eccentricity)); }

MechanismLabels place_labels(const MechanismView& at, const MechanismCameras& cameras, const LabelNeeds& needs,
                             SweptRegion& swept, SweptRegion& in_contact) {
    MechanismLabels out;
    const LabelPlacer placer(at, cameras, needs);
    out.arc_radius = placer.arc_radius();
    if (!at.labelled()) return out;
    Image scratch(1, 1);
    Canvas canvas(scratch, *at.context.fonts);
    const auto take = [&](const LabelPlace& label) {
        for (SweptRegion* each : {&swept, &in_contact}) each->room.cover(placer.box(label), kText);
    };
    for (SweptRegion* each : {&swept, &in_contact}) each->room.cover(placer.arc(out.arc_radius), 1);
    if (at.problem().cam) {
        out.speed =
            placer.speed(swept.room, canvas.measure(speed_label(at), {.size = label_size(at)}).w, out.speed_way);
        take(*out.speed);
        for (SweptRegion* each : {&swept, &in_contact})
            for (const Box& box : placer.arrow_boxes(out.speed_way)) each->room.cover(box, 1);
    }
    out.angle = placer.angle(swept.room, out.arc_radius);
    if (out.angle) take(*out.angle);
    if (!needs.arrows.empty()) {
        out.force = place_force_label(at, cameras, needs, in_contact.room, canvas);
        take(*out.force);
    }
    return out;
}

}  // namespace beamcam::render
