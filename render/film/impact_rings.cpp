#include "render/film/impact_rings.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "render/mechanism/cam_outline.hpp"
#include "sim/cam/cam_shape.hpp"

namespace beamcam::render {
namespace {

constexpr double kRing = 0.4;             // lifetime of a ring, freezes not counted [s]
constexpr std::ptrdiff_t kMostRings = 6;  // at once

}  // namespace

// Impacts before the first frame and after the last one have none.
ImpactRings::ImpactRings(const MechanismView& at) {
    const std::vector<double>& times = at.context.clock.times;
    for (const sim::Impact& impact : at.motion().impacts) {
        const auto first = std::ranges::lower_bound(times, impact.t_start);
        if (first == times.end() || (first == times.begin() && *first > impact.t_start)) continue;
        const int frame = static_cast<int>(first - times.begin());
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
    const std::vector<int>& moved = s.at.context.clock.moved;
    const auto age = [&](const Ring& ring) {  // in lifetimes; a freeze stops it
        return (moved[static_cast<std::size_t>(s.frame)] - moved[static_cast<std::size_t>(ring.frame)]) /
               (kRing * s.at.context.setup->fps);
    };
    const auto later = std::ranges::upper_bound(rings_, s.frame, {}, &Ring::frame);
    for (const Ring& r : std::span(later - std::min(kMostRings, later - rings_.begin()), later)) {
        const double share = age(r);
        if (share >= 1) continue;
        const Vec2 at =
            s.px(on_cam(s.pose, sim::cam_shape(s.at.problem())->at(r.material_angle).position(r.material_angle)));
        s.canvas.circle(at, (7 + 20 * std::sqrt(share)) * s.at.marks);
        s.canvas.stroke(
            {s.at.palette.contact.faded((1 - share) * (1 - share)), (3.2 - 2 * share) * std::max(s.at.marks, 0.45)});
    }
}

}  // namespace beamcam::render
