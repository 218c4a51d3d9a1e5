// What a mechanism's panel shows over the whole film, gathered once: the regions in which labels and captions have no
// place, and the points that a camera may follow.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "render/film/caption_places.hpp"
#include "render/film/label_visibility.hpp"
#include "render/film/mechanism_panel.hpp"

namespace beamcam::render {

using sim::Pose;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kCaptionCell = 20;  // rows of the boxes that captions avoid [design px]

}  // namespace

// The largest radius of an arc about `centre` over these angles that stays inside the box.
static double arc_room(Range angles, Vec2 centre, const Box& box) {
    Bounds reach;  // of the unit arc [px]
    constexpr int kSteps = 64;
    for (int i = 0; i <= kSteps; ++i) reach.add(down(angles.low + (angles.high - angles.low) * i / kSteps));
    const auto fits = [](double room, double need) {
        return need > 1e-3 ? std::max(room, 0.0) / need : std::numeric_limits<double>::infinity();
    };
    return std::min({fits(centre.x - box.x, -reach.x0), fits(box.right() - centre.x, reach.x1),
                     fits(centre.y - box.y, -reach.y0), fits(box.bottom() - centre.y, reach.y1)});
}

// The survey covers all motions, so that labels of several mechanisms have the same places.
void MechanismPanel::add_survey(SweptRegion& swept) const {
    for (const std::vector<Vec2>& strip : at_.context.extent.strips) {
        std::vector<Vec2> face, back;
        for (std::size_t i = 0; i + 1 < strip.size(); i += 2)
            face.push_back(at_.px(strip[i])), back.push_back(at_.px(strip[i + 1]));
        swept.add_beam(face, back);
    }
    for (const ViewExtent::ForceArrow& arrow : at_.context.extent.arrows)
        swept.add_arrow({arrow.foot, arrow.normal, arrow.share * at_.context.arrow_scale});
}

static void add_measured(const MechanismView& at, const Pose& pose, const DrawnBeam& drawn, SweptRegion& swept) {
    for (std::size_t k = 0; k < at.context.setup->data.size(); ++k) {
        const auto beam = measured_beam(at, k, pose, drawn);
        std::vector<Vec2> face, back;
        for (std::size_t i = 0; beam && i < beam->line.size(); ++i)
            face.push_back(at.px(beam->face(i))), back.push_back(at.px(beam->back(i)));
        swept.add_beam(face, back);
    }
}

// Between the previous frame and this one.
void MechanismPanel::add_tips_before(int frame) {
    if (frame == 0) return;
    const std::vector<sim::Pose>& path = at_.motion().path;
    const double from = at_.context.at(frame - 1), to = at_.context.at(frame);
    for (auto pose = std::ranges::upper_bound(path, from, {}, &sim::Pose::t); pose != path.end() && pose->t < to;
         ++pose)
        tip_path_.add_between_frames(knot_of(at_, *pose));
}

LabelNeeds MechanismPanel::add_frames(SweptRegion& swept, SweptRegion& in_contact, std::vector<Followed>& followed) {
    LabelNeeds needs{{kInfinity, -kInfinity}, kInfinity, {}, {}};
    Bounds seen;
    std::vector<Vec2> before;
    for (int k = 0; k < at_.context.frames(); ++k) {
        const auto [pose, drawn, shape] = at_.drawn_frame(k);
        const double angle = drawn_angle(pose);
        needs.angles = {std::min(needs.angles.low, angle), std::max(needs.angles.high, angle)};
        const Vec2 tip = (shape.face.back() + shape.back.back()) * 0.5;
        add_tips_before(k);
        tip_path_.add_frame({pose.t, tip, pose.theta});
        followed.push_back({at_.look.camera.to_world(tip),
                            drawn.contact ? drawn.contact->on_disc : at_.look.camera.to_world(tip),
                            at_.problem().cam ? pose.cam_centre : Vec2{}});
        const std::optional<ForceArrow> arrow = force_arrow_of(pose, drawn, rings_.peak(k, drawn));
        for (SweptRegion* each : {&swept, &in_contact}) {
            if (each == &in_contact && !arrow) continue;
            each->add_beam(shape.face, shape.back);
            each->add_motion(before, shape.face);
            if (arrow) each->add_arrow(*arrow);
        }
        if (at_.member == 0) add_measured(at_, pose, drawn, swept);
        if (arrow) needs.arrows.push_back(*arrow), needs.frames.push_back(k);
        before = shape.face;
        for (std::size_t i = 0; i < shape.face.size(); ++i) seen.add(shape.face[i]), seen.add(shape.back[i]);
        seen.add(shape.hinge, shape.hub);
        if (shape.disc) seen.add(shape.disc->centre, shape.disc->radius);
    }
    tip_path_.complete(at_);
    for (int k = 0; k + 1 < at_.context.frames(); ++k)
        for (SweptRegion* each : {&swept, &in_contact})
            each->add_curve(tip_path_.piece(at_, static_cast<std::size_t>(k)));  // the trail
    const Range from_rest{std::min(needs.angles.low, 0.0), std::max(needs.angles.high, 0.0)};
    needs.arc_room = arc_room(from_rest, at_.px({0, 0}), at_.box.inset(4 * at_.unit));
    // Shadows fade out in the gap around the panel.
    lit_box_ = lit_box(seen.box(), at_.box.inset(-std::floor(10 * at_.unit)), at_.unit);
    return needs;
}

// Boxes around everything that moves while the caption is shown and the arc of θ, before a near camera also around
// labels.
std::vector<Box> MechanismPanel::moving_under(const Callout& caption) const {
    OccupancyGrid room(at_.box, kCaptionCell * at_.unit);
    std::vector<Vec2> before;
    for (int k = caption.first; k <= std::min(caption.last, at_.context.frames() - 1); ++k) {
        const SeenFrame now(cameras_, k);
        SweptRegion swept(now.at, std::move(room),
                          cameras_.near() && now.projection ? std::vector{*now.projection} : cameras_.projections());
        for (int m = 0; m < (at_.ghosts ? at_.context.members() : 1); ++m) {
            const auto [pose, drawn, shape] =
                now.at.drawn_pose(m, at_.context.motion(m).pose(static_cast<std::size_t>(k)));
            swept.add_shape(shape);
            if (m > 0) continue;
            swept.add_motion(before, shape.face);
            before = shape.face;
            if (const auto arrow = force_arrow_of(pose, drawn, rings_.peak(k, drawn))) swept.add_arrow(*arrow);
            add_measured(now.at, pose, drawn, swept);
        }
        if (const Pose pose = at_.context.pose(at_.member, k); shows_angle_arc(now.at, labels_.arc_radius, pose)) {
            swept.add_curve(angle_arc(now.at, labels_.arc_radius, pose));
            if (now.projection) swept.add_curve(angle_base(now.at, labels_.arc_radius));
        }
        room = std::move(swept.room);
        for (const auto* label : {&labels_.angle, &labels_.speed})
            if (cameras_.near() && *label && (*label)->opacity_at(k) > 0)
                room.cover(now.at.label_box(**label, now.by(), {}, k));
    }
    return room.covered_boxes();
}

// A caption keeps its place while it is shown, so that it has to avoid every pose of this time. One at the tip moves
// with it, unless the camera does.
void MechanismPanel::place_captions() {
    const std::vector<Callout>& all = at_.context.setup->callouts;
    std::vector<const Callout*> in_order;
    for (const Callout& each : all)
        if (cameras_.near() || CaptionPlaces::kind_of(each) != Anchor::Kind::tip) in_order.push_back(&each);
    std::ranges::sort(in_order, [](auto* a, auto* b) { return CaptionPlaces::comes_before(*a, *b); });
    labels_.captions.resize(all.size());
    Image scratch(1, 1);
    Canvas canvas(scratch, *at_.context.fonts);
    for (const Callout* each : in_order) {
        const SeenFrame first(cameras_, std::clamp(each->first, 0, at_.context.frames() - 1));
        const auto [pose, drawn, shape] = first.at.drawn_frame(first.frame);
        const auto arrow = force_arrow_of(pose, drawn, rings_.peak(first.frame, drawn));
        const MechanismScene scene{canvas, first.frame, pose, drawn, shape, first.at, first.by(), arrow};
        labels_.captions[std::size_t(each - all.data())] = CaptionPlaces(scene).placed(*each, moving_under(*each));
    }
}

}  // namespace beamcam::render
