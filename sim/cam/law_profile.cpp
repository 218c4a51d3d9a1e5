// The outline that moves a straight lever by a law. MODEL.md (S103).
#include <numbers>
#include <utility>

#include "sim/base/numerics.hpp"
#include "sim/cam/profile_spans.hpp"

namespace beamcam::sim {
namespace {

double normal_angle(const ProgrammedMotion::Segment& segment, double phi) {
    return ProgrammedMotion::at(segment, phi).theta + std::numbers::pi / 2 + phi;
}

// φ in [low, high] of the normal α.
double turn_of_normal(const ProgrammedMotion::Segment& segment, double alpha, double low, double high) {
    return increasing_root(
        [&](double phi) {
            const LeverMotion motion = ProgrammedMotion::at(segment, phi);
            return std::pair(motion.theta + std::numbers::pi / 2 + phi - alpha, 1 + motion.velocity);
        },
        low, high);
}

}  // namespace

CamPoint touched_point(const LeverMotion& motion, Vec2 centre, double offset) {
    const Vec2 u = unit(motion.theta);
    const double along = dot(centre, u), across = dot(centre, perp(u));
    const double turned = 1 + motion.velocity;  // dα/dφ
    const double curved = ((along * motion.acceleration + across * motion.velocity * motion.velocity) * turned -
                           along * motion.velocity * motion.acceleration) /
                          (turned * turned * turned);
    const double h = -across - offset;
    return {h, along * motion.velocity / turned, h + curved};
}

std::vector<ProfileSpan> spans_of(const LawProfile& profile, Vec2 centre, double offset) {
    std::vector<ProfileSpan> spans;
    const ProgrammedMotion motion(profile);
    for (const ProgrammedMotion::Segment& segment : motion.segments()) {
        std::vector<double> ends{0};
        for (const double u : law_breaks(segment.law)) ends.push_back(u);
        ends.push_back(1);
        for (std::size_t i = 1; i < ends.size(); ++i) {
            const double low = segment.start + ends[i - 1] * segment.over,
                         high = segment.start + ends[i] * segment.over;
            const double from = normal_angle(segment, low), to = normal_angle(segment, high);
            if (!(from < to)) continue;
            spans.push_back({from, to, [segment, low, high, centre, offset](double alpha) {
                                 const double phi = turn_of_normal(segment, alpha, low, high);
                                 return touched_point(ProgrammedMotion::at(segment, phi), centre, offset);
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
