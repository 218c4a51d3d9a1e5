#include "render/film/impact_rings.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/mechanism/cam_outline.hpp"
#include "sim/cam/cam_shape.hpp"

namespace beamcam::render {
namespace {

constexpr double kRing = 0.3;  // lifetime of a ring, freezes not counted [s of the film]

// The time between two frames, in lifetimes of a ring.
double age(const MechanismView& at, int from, int to) {
    const std::vector<int>& moved = at.context.clock.moved;
    return (moved[static_cast<std::size_t>(to)] - moved[static_cast<std::size_t>(from)]) /
           (kRing * at.context.setup->fps);
}

}  // namespace

// Impacts before the first frame and after the last one have none, nor those within the lifetime of a ring after
// another impact.
ImpactRings::ImpactRings(const MechanismView& at) {
    const std::vector<double>& times = at.context.clock.times;
    int last = -1;  // frame of the last impact
    for (const sim::Impact& impact : at.motion().impacts) {
        const auto first = std::ranges::lower_bound(times, impact.t_start);
        if (first == times.end() || (first == times.begin() && *first > impact.t_start)) continue;
        const int frame = static_cast<int>(first - times.begin()), before = std::exchange(last, frame);
        if (before >= 0 && age(at, before, frame) < 1) continue;
        const sim::Pose pose = at.context.pose(at.member, frame);
        const DrawnBeam beam = at.drawn(at.member, pose);
        if (!beam.contact) continue;
        const Vec2 n = beam.contact->normal;
        rings_.push_back({frame, std::atan2(n.y, n.x) - pose.cam_angle});
    }
}

// Rings move with the disc.
void ImpactRings::draw(const MechanismScene& s) const {
    if (!s.at.problem().cam) return;
    const auto next = std::ranges::upper_bound(rings_, s.frame, {}, &Ring::frame);
    if (next == rings_.begin()) return;
    const Ring& r = *std::prev(next);
    const double share = age(s.at, r.frame, s.frame);
    if (share >= 1) return;
    const Vec2 at =
        s.px(on_cam(s.pose, sim::cam_shape(s.at.problem())->at(r.material_angle).position(r.material_angle)));
    s.canvas.circle(at, (7 + 20 * std::sqrt(share)) * s.at.marks);
    s.canvas.stroke(
        {s.at.palette.contact.faded((1 - share) * (1 - share)), (3.2 - 2 * share) * std::max(s.at.marks, 0.45)});
}

}  // namespace beamcam::render
