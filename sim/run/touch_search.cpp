#include "sim/run/touch_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/assert.hpp"
#include "sim/contact/chatter.hpp"

namespace beamcam::sim {
namespace {

constexpr long kEvaluationsPerReport = 256;      // evaluations of the gap between two calls within one step
constexpr long kMostAdvances = 10000;            // through one step: beyond, its vibrations are resolved
constexpr double kShortestAdvanceShare = 1e-15;  // of the time: rounding
constexpr double kTouchGap = 1e-16;              // of the cam's radius: rounding
constexpr int kMaxOpeningHalvings = 24;          // of the first subinterval, in search of an open gap after a release
constexpr double kFootStiffness = 0.5;  // least r″·D + r′·r′ for which the gap's acceleration is bounded
constexpr double kGapErrors = 10;       // step tolerances in the gap: several coordinates contribute

// An instant after the start at which the gap is open, by halving the interval; the start itself if none is found.
template <class Probe>
Guard opening(Probe&& probe, const Guard& start, double later) {
    for (int k = 1; k <= kMaxOpeningHalvings; ++k) {
        const Guard g = probe(start.t + std::ldexp(later - start.t, -k));
        if (g.value > 0) return g;
    }
    return start;
}

}  // namespace

std::optional<double> TouchSearch::first_touch(const Segment& segment) {
    if (const auto bounds = segment.bounds()) return by_advancement(segment, *bounds);
    const SegmentProbe::Range range = probe_.range(segment);
    const double half = 0.5 * (segment.t1 - segment.t0);
    if (lower_bound(segment.t0 + half, half, range.middle.data(), range.spread.data()) > 0) return {};
    return by_pieces(segment, segment.t1, std::max(probe_.pieces(segment), probe_.pieces_by_travel(segment, range)));
}

double TouchSearch::lower_bound(double t, double h, const double* xi, const double* spread) const {
    return probe_.system.gap_bound().lower_bound(probe_.system.drive(), t, h, xi, spread);
}

// Samples the gap at the ends of `count` equal subintervals and searches each for minima below zero.
std::optional<double> TouchSearch::by_pieces(const Segment& segment, double end, int count) {
    const double h = end - segment.t0;
    const auto probe = [&](double t) {
        const ContactState c = probe_.contact(segment, t);
        return Guard{t, c.gap, c.gap_rate};
    };
    const ContactState first = probe_.contact(segment, segment.t0);
    Guard a{segment.t0, first.gap, first.gap_rate};
    for (int i = 1; i <= count; ++i) {
        const double t = i == count ? end : segment.t0 + h * i / count;
        const Guard b = probe(t);
        if (i == 1 && segment.t0 == state_.phase_start && b.value <= 0) {
            // The flight starts on the surface and soon lies below it: find an instant in between with an open gap.
            if (!(a.rate < -kRestSpeed)) a = opening(probe, a, b.t);
            if (!(a.value > 0) && !opens(segment, segment.t0)) return segment.t0;
        } else if (i == 1 && segment.t0 == state_.phase_start) {
            a.value = std::max(a.value, 0.0);  // rounding at the release
            a.rate = std::max(a.rate, 0.0);
        }
        const auto at = first_fall(probe, a, b, probe_.gap_rounding());
        if (at && !opens(segment, *at)) return *at;
        // The gap opened by less than the error of the step, and now closes.
        const double deep = step_error();
        if (a.value > -deep && b.value < -deep)
            return find_root([&](double s) { return probe(s).value + deep; }, a.t, b.t, a.value + deep, b.value + deep);
        a = b;
    }
    return {};
}

// Of the gap, at most [m].
double TouchSearch::step_error() const {
    const Solver& solver = problem().solver;
    return kGapErrors * (solver.rtol * reach() + solver.atol);
}

// At an instant with a negative gap: true if it is an integration error of a gap that opens, because the beam
// accelerates away from the cam. After a lift the gap grows like t³, at first more slowly than the error.
bool TouchSearch::opens(const Segment& segment, double t) {
    const ContactState c = probe_.contact(segment, t);
    if (c.gap_rate < -problem().contact.approach_floor.value || c.gap < -step_error()) return false;
    const double pull = probe_.system.free_gap_acceleration(t, probe_.state());
    return pull > 0 && (c.gap_rate > 0 || c.gap_rate * c.gap_rate < 2 * pull * probe_.gap_rounding());
}

// Upper bound of |g̈| from the terms of (S44), for penetrations up to half the cam's least radius of curvature and
// distances of the foot from the centre of curvature up to `far`. Infinite if the beam may bend so much that the foot
// is not unique.
double TouchSearch::gap_acceleration_bound(const MotionBounds& b, double far) const {
    const CamShape& shape = cam().shape();
    const double near = 0.5 * shape.least_radius(), arm = shape.largest_arm() * std::fabs(cam().speed());
    if (!(b.curvature * far < kFootStiffness)) return std::numeric_limits<double>::infinity();
    far = std::max(far, reach() + shape.largest_radius());
    const double speed = b.theta_dot * reach() + b.deflection_speed + arm;  // |w|, w = ṙ − Ḃ
    const double turn = b.theta_dot + b.slope_speed;                        // |ṙ′|
    const double slide = (turn * far + speed) / kFootStiffness;             // |ẋ|
    const double point = b.deflection_acceleration + b.theta_ddot * reach() + 2 * b.theta_dot * b.deflection_speed +
                         b.theta_dot * b.theta_dot * reach() + b.deflection_speed * b.slope_speed;  // |r̈|
    return (speed + slide) * speed / near + point + turn * slide + arm * std::fabs(cam().speed());
}

// Conservative advancement: from an open gap g with rate ġ no touch can occur before g + ġτ − ½Mτ² = 0, with M ≥ |g̈|.
// So practically no touch is missed. Once g + ġτ + ½Mτ² has a root, a touch is certain, and Newton's method finds
// it.
//                                                                                              (S56)
std::optional<double> TouchSearch::by_advancement(const Segment& segment, const MotionBounds& bounds) {
    const double h = segment.t1 - segment.t0;
    const double no_spread[kMaxSize] = {};
    const double speed =
        bounds.theta_dot * reach() + bounds.deflection_speed + cam().shape().largest_slope() * std::fabs(cam().speed());
    BEAMCAM_ASSERT(state_.t == segment.t0);
    if (lower_bound(segment.t0, 0, state_.y.data(), no_spread) > h * speed) return {};

    double t = segment.t0;
    ContactState c = probe_.gap(segment, t);
    const double far = cam().shape().largest_radius() + probe_.system.offset() + std::max(c.gap, 0.0) + h * speed;
    const double most = gap_acceleration_bound(bounds, far);
    if (!std::isfinite(most)) return by_resolving(segment);
    const Advancement gap{most, most};
    if (t == state_.phase_start) {
        if (!(c.gap_rate > kRestSpeed)) {
            // The beam hardly leaves the surface: sample densely at first.
            t = std::min(segment.t1, t + 1 / (probe_.system.highest_frequency() + bounds.theta_dot + 1 / h));
            if (const auto touch = by_pieces(segment, t, 4)) return touch;
            c = probe_.gap(segment, t);
        }
        c.gap = std::max(c.gap, 0.0);  // rounding at the release
    }
    return advance(segment, t, c, gap);
}

// Advances from t, with the gap c.gap.
std::optional<double> TouchSearch::advance(const Segment& segment, double t, ContactState c, const Advancement& gap) {
    for (long count = 0; count < kMostAdvances; ++count) {
        if (count % kEvaluationsPerReport == kEvaluationsPerReport - 1) report_(segment.t0);
        // An opening gap is negative only by rounding.
        if (c.gap < 0 && c.gap_rate > 0 && c.gap > -kLowestBounce * problem().beam.length) c.gap = 0;
        if (c.gap < 0 || (c.gap == 0 && c.gap_rate < 0)) return t;
        if (const auto certain = gap.certain_time(c.gap, c.gap_rate)) {
            const auto evaluate = [&](double at) {
                const ContactState there = probe_.gap(segment, at);
                return GapAt{there.gap, there.gap_rate};
            };
            return falling_zero(evaluate, t, {c.gap, c.gap_rate}, t + *certain, segment.t1,
                                kTouchGap * cam().shape().largest_radius());
        }
        const double safe = gap.clear_time(c.gap, c.gap_rate);
        const double next = t + std::max(safe, kShortestAdvanceShare * t);
        if (next >= segment.t1) return {};
        t = next;
        c = probe_.gap(segment, t);
    }
    return by_resolving(segment);
}

// Subintervals resolve the fastest vibration and the turning of the cam.
std::optional<double> TouchSearch::by_resolving(const Segment& segment) {
    const double fastest = std::max(probe_.system.highest_frequency(), probe_.system.cam_rate());
    const double turns = (segment.t1 - segment.t0) * fastest;
    return by_pieces(segment, segment.t1, std::max(kMaxPieces, probe_.limited(turns)));
}

}  // namespace beamcam::sim
