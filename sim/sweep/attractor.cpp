#include "sim/sweep/attractor.hpp"

#include <algorithm>
#include <cmath>

#include "sim/cam/cam_shape.hpp"

namespace beamcam::sim {
namespace {

constexpr double kSameState = 1e-5;          // of the cam's lift and its rate: closer states are equal
constexpr double kUsualLift = 1e-3;          // [rad] in place of a lift of zero
constexpr int kPeriodRepeats = 3;            // least number of repetitions of a period in the compared turns
constexpr std::size_t kFewestTurns = 12;     // least number of turns for the classes without a period
constexpr double kDifferenceNoise = 1e-7;    // of the lift: smaller changes of a difference are ignored
constexpr double kSettledShare = 0.1;        // of a difference: largest distance of its extrapolated limit
constexpr double kVanishingMismatch = 0.02;  // of the lift: a smaller distance from a period may still vanish

using Strobes = std::span<const Strobe>;

// Scale of differences between states: the cam's lift and its rate.
struct Scale {
    double angle, rate;
    double between(const Strobe& a, const Strobe& b) const {
        return std::max(std::fabs(a.theta - b.theta) / angle, std::fabs(a.theta_dot - b.theta_dot) / rate);
    }
};
Scale scale_of(const Problem& problem, const SampledMotion& motion) {
    double lift = 0;
    if (problem.cam && norm(problem.cam->centre) > 0)
        lift = cam_shape(problem)->largest_slope() / norm(problem.cam->centre);
    if (lift == 0) lift = kUsualLift;
    lift = std::max(lift, motion.accuracy / kSameState);
    return {lift, lift / cam_period(problem)};
}

// The largest distance between the states and the corresponding ones of the last n turns, which reveals slow drifts.
double mismatch(const Scale& scale, Strobes s, std::size_t n) {
    double most = 0;
    for (std::size_t k = 0; k + n < s.size(); ++k)
        most = std::max(most, scale.between(s[k], s[s.size() - n + (k - s.size() % n + n) % n]));
    return most;
}

// The smallest period that the states repeat at least kPeriodRepeats times; 0: none. (S87)
std::size_t period_of(const Scale& scale, Strobes s) {
    for (std::size_t n = 1; n * kPeriodRepeats < s.size(); ++n)
        if (mismatch(scale, s, n) < kSameState) return n;
    return 0;
}

// True if states n turns apart agree, but differences at a shorter period d | n still change: extrapolation of three
// equally spaced ones (Aitken) has a limit that is not near the last one.
bool period_changes(const Scale& scale, Strobes s, std::size_t n) {
    for (std::size_t d = 1; d <= n / 2; ++d) {
        const std::size_t apart = n * ((s.size() - 1 - d) / (2 * n));
        if (n % d != 0 || apart == 0) continue;
        const auto difference = [&](std::size_t back) {
            const std::size_t k = s.size() - 1 - back;
            return scale.between(s[k], s[k - d]);
        };
        const double first = difference(2 * apart), middle = difference(apart), last = difference(0);
        if (std::fabs(last - first) < kDifferenceNoise) continue;
        const double bend = (last - middle) - (middle - first), step = last - middle;
        if (!(std::fabs(step * step) < kSettledShare * last * std::fabs(bend))) return true;
    }
    return false;
}

// The later half stays near a period, although not within the tolerance.                                   (S88)
bool is_near_period(const Scale& scale, Strobes s) {
    const Strobes late = s.last(s.size() / 2);
    for (std::size_t n = 1; n * kPeriodRepeats < late.size(); ++n)
        if (mismatch(scale, late, n) < kVanishingMismatch) return true;
    return false;
}

bool nothing_moves(const Problem& problem, const Scale& scale, Strobes s) {
    const bool still = !problem.cam || problem.cam->speed == 0 || cam_shape(problem)->largest_slope() == 0;
    return still && mismatch(scale, s, 1) < kSameState &&
           std::ranges::all_of(s, [&](const Strobe& at) { return std::fabs(at.theta_dot) < kSameState * scale.rate; });
}

}  // namespace

bool has_section(AttractorClass kind) {
    return kind == AttractorClass::periodic || kind == AttractorClass::chaotic || kind == AttractorClass::aperiodic;
}

Attractor classify(const Problem& problem, const SampledMotion& motion) {
    Attractor out;
    if (motion.over_the_top) {
        out.kind = AttractorClass::over_the_top;
        return out;
    }
    const Strobes s = motion.strobes;
    if (!motion.failure.empty() || s.size() < 2) return out;
    const Scale scale = scale_of(problem, motion);
    const bool lasts = std::ranges::all_of(s, &Strobe::touching) && std::ranges::none_of(s.subspan(1), &Strobe::left);
    if (nothing_moves(problem, scale, s)) {
        out.kind = AttractorClass::rest;
        return out;
    }
    if (lasts) {
        out.kind = AttractorClass::following;
        out.period = 1;
        out.impacts_per_period = 0;
        return out;
    }
    const auto turns = s.size() - 1;
    const auto impacts = [&](std::size_t from, std::size_t to) {
        return static_cast<double>(s[to].impacts - s[from].impacts);
    };
    // The period of the last third must hold for all states.
    std::size_t n = period_of(scale, s.last(s.size() / 3 + 1));
    if (n == 0) n = period_of(scale, s);
    if (n > 0) {
        const bool throughout = n * kPeriodRepeats < s.size() && mismatch(scale, s, n) < kSameState;
        if (!throughout || period_changes(scale, s, n)) return out;
        out.kind = AttractorClass::periodic;
        out.period = static_cast<int>(n);
        out.impacts_per_period = impacts(turns - n, turns);
        return out;
    }
    if (s.size() >= kFewestTurns && !is_near_period(scale, s)) out.kind = AttractorClass::aperiodic;
    out.impacts_per_period = impacts(0, turns) / static_cast<double>(turns);
    return out;
}

}  // namespace beamcam::sim
