// The outline that moves a straight lever by a law. MODEL.md (S103).
#include <numbers>
#include <utility>

#include "sim/base/numerics.hpp"
#include "sim/cam/profile_spans.hpp"

namespace beamcam::sim {
namespace {

// φ in [low, high] where θ + φ has this value.
double turn_of(const ProgrammedMotion::Segment& segment, double sum, double low, double high) {
    return increasing_root(
        [&](double phi) {
            const LeverMotion motion = ProgrammedMotion::at(segment, phi);
            return std::pair(motion.theta + phi - sum, 1 + motion.velocity);
        },
        low, high);
}

}  // namespace

CamPoint touched_point(const LeverMotion& motion, Vec2 centre, double offset, double side) {
    const Vec2 u = unit(motion.theta);
    const double along = dot(centre, u), across = dot(centre, perp(u));
    const double turned = 1 + motion.velocity;  // dα/dφ
    const double curved = ((along * motion.acceleration + across * motion.velocity * motion.velocity) * turned -
                           along * motion.velocity * motion.acceleration) /
                          (turned * turned * turned);
    const double h = -side * across - offset;
    return {h, side * along * motion.velocity / turned, h + side * curved};
}

double side_of(const LawProfile& profile, Vec2 centre) { return cross(centre, unit(profile.lowest)) < 0 ? -1 : 1; }

std::vector<ProfileSpan> spans_of(const LawProfile& profile, Vec2 centre, double offset) {
    std::vector<ProfileSpan> spans;
    const double side = side_of(profile, centre), upright = side * std::numbers::pi / 2;
    const ProgrammedMotion motion(profile);
    for (const ProgrammedMotion::Segment& segment : motion.segments()) {
        std::vector<double> ends{0};
        for (const double u : law_breaks(segment.law)) ends.push_back(u);
        ends.push_back(1);
        for (std::size_t i = 1; i < ends.size(); ++i) {
            const double low = segment.start + ends[i - 1] * segment.over,
                         high = segment.start + ends[i] * segment.over;
            const double from = ProgrammedMotion::at(segment, low).theta + low + upright,
                         to = ProgrammedMotion::at(segment, high).theta + high + upright;
            if (!(from < to)) continue;
            spans.push_back({from, to, [segment, low, high, centre, offset, side, upright](double alpha) {
                                 const double phi = turn_of(segment, alpha - upright, low, high);
                                 return touched_point(ProgrammedMotion::at(segment, phi), centre, offset, side);
                             }});
        }
    }
    return spans;
}

std::vector<ProfileSpan> spans_of(const Problem& problem) {
    const Cam& cam = *problem.cam;
    if (const auto* law = std::get_if<LawProfile>(&*cam.profile))
        return spans_of(*law, cam.centre, contact_offset(problem));
    if (const auto* arcs = std::get_if<ArcsProfile>(&*cam.profile)) return spans_of(*arcs);
    return spans_of(std::get<PointsProfile>(*cam.profile));
}

}  // namespace beamcam::sim
