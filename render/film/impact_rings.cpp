#include "render/film/impact_rings.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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
        if (const DrawnBeam beam = at.beam_of(at.member, frame); beam.contact)
            rings_.push_back({frame, beam.contact->on_disc});
    }
}

void ImpactRings::draw(const MechanismScene& s) const {
    const auto next = std::ranges::upper_bound(rings_, s.frame, {}, &Ring::frame);
    if (next == rings_.begin()) return;
    const Ring& r = *std::prev(next);
    const double share = age(s.at, r.frame, s.frame);
    if (share >= 1) return;
    s.canvas.circle(s.px(r.place), (7 + 20 * std::sqrt(share)) * s.at.marks);
    s.canvas.stroke(
        {s.at.palette.contact.faded((1 - share) * (1 - share)), (3.2 - 2 * share) * std::max(s.at.marks, 0.45)});
}

}  // namespace beamcam::render
