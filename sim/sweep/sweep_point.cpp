#include "sim/sweep/sweep_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "sim/orbit/exponents.hpp"
#include "sim/run/run.hpp"
#include "sim/sweep/constants.hpp"
#include "sim/sweep/rigid_motion.hpp"
#include "sim/sweep/sampler.hpp"

namespace beamcam::sim {
namespace {

// Continues the motion for the duration of its samples, with tangents, and classifies it by its largest exponent.
// Samples cover whole turns, so the cam has its initial phase again.
Attractor by_tangents(const Problem& problem, const Sampling& sampling, const SweepPoint& point,
                      const Progress& progress) {
    const SampleSpan span = sample_span(problem, sampling);
    ExponentsRequest request;
    request.duration = static_cast<double>(span.kept()) * cam_period(problem);
    request.start = carried(problem, point.motion.end);
    try {
        const Exponents found = lyapunov_exponents(problem, request, progress);
        if (found.lambda.empty()) return point.attractor;  // a rigid beam on a prescribed hub has no tangents
        const double late = found.settled ? found.lambda.front() * found.duration / 2 : kNan;
        return with_exponent(point.attractor, {found.lambda.front(), found.error.front(), late, found.doubt});
    } catch (const SolverError&) {
        return point.attractor;  // the exponent remains unknown
    }
}

// The sampling of a continuation of the same duration, with the closed forms of at least kLaterTurns.
Sampling later(const Problem& problem, Sampling sampling) {
    const SampleSpan span = sample_span(problem, sampling);
    const long least = RigidMotion::applies(problem, sampling) ? kLaterTurns : 0;
    sampling.keep = {static_cast<double>(span.kept()), {}};
    sampling.transient = {static_cast<double>(std::max(span.from, least - span.kept())), {}};
    return sampling;
}

// The continuation of a chaotic motion has no period.                                                      (S89a)
bool stays_chaotic(const Problem& problem, SampledMotion motion) {
    if (classify(problem, motion).kind == AttractorClass::chaotic) return true;
    // The exponent of these turns may be less certain; only the absence of a period matters here.
    for (Strobe& strobe : motion.strobes) strobe.growth = kNan;
    return classify(problem, motion).kind == AttractorClass::aperiodic;
}

// Sustained contact ends at a few phases of the cam: a motion that reaches the same one twice is periodic.   (S89b)
Attractor returning(const RigidMotion::Return& period) {
    Attractor out;
    out.kind = AttractorClass::periodic;
    out.period = static_cast<int>(period.turns);
    out.impacts_per_period = static_cast<double>(period.impacts);
    out.exponent = {-std::numeric_limits<double>::infinity(), 0, kNan};
    return out;
}

// Differences may grow so much between two returns that only rounding closes the orbit. A period must survive small
// changes of the cam's speed; the number of bounces that its chatter lists need not.                         (S89b)
bool survives(long turns, const Problem& problem, const Sampling& sampling, const InitialState& end,
              const Progress& progress) {
    const auto returns = [&](double share) {
        Problem nearby = problem;
        nearby.cam->speed *= 1 + share * kNearbySpeed;
        const Sampling continuation = later(nearby, sampling);
        RigidMotion motion(nearby, continuation, &end);
        motion.follow(progress, true);
        return motion.returned() && motion.returned()->turns == turns;
    };
    constexpr double kShares[] = {1, -1, 0.5, -0.5};  // one alone may return by chance
    return std::ranges::all_of(kShares, returns);
}

SweepPoint point_by_closed_forms(const Problem& problem, const Sampling& sampling, const InitialState* start,
                                 const Progress& progress) {
    SweepPoint point;
    RigidMotion motion(problem, sampling, start);
    point.motion = motion.follow(progress);
    point.attractor = classify(problem, point.motion);
    // Or seems so, with near-grazing impacts.
    const AttractorClass kind = point.attractor.kind;
    const bool chaotic = kind == AttractorClass::chaotic || kind == AttractorClass::aperiodic;
    // Sustained contact in each period.
    const bool returns =
        kind == AttractorClass::periodic && point.attractor.exponent.value == -std::numeric_limits<double>::infinity();
    if (!chaotic && !returns && (kind != AttractorClass::unsettled || !point.motion.rested)) return point;
    std::optional<RigidMotion::Return> period = motion.returned();
    if (returns) period = {point.attractor.period, std::lround(point.attractor.impacts_per_period)};
    InitialState end = point.motion.end;
    if (!period) {
        const Sampling as_long_again = later(problem, sampling);
        RigidMotion rest(problem, as_long_again, &point.motion.end);
        const SampledMotion after = rest.follow(progress);
        period = rest.returned();
        end = after.end;
        if (!period && chaotic && (after.rested || !stays_chaotic(problem, after)))
            point.attractor.kind = AttractorClass::unsettled;
    }
    if (!period) return point;
    if (survives(period->turns, problem, sampling, end, progress)) {
        point.attractor = returning(*period);
    } else {
        // The impacts of a motion without a period are counted per turn.
        const double turns = returns ? point.attractor.period : 1;
        point.attractor = {AttractorClass::aperiodic, 0, point.attractor.impacts_per_period / turns, {}};
    }
    return point;
}

SweepPoint point_by_run(const Problem& problem, const Sampling& sampling, const InitialState* start,
                        const Progress& progress) {
    SweepPoint point;
    std::optional<InitialState> moved;
    if (start) moved = carried(problem, *start);
    point.motion = sample_by_run(problem, sampling, moved ? &*moved : nullptr, progress);
    point.attractor = classify(problem, point.motion);
    if (sampling.kind == SampleKind::peaks) return point;  // no exponents, which cost more than the motion
    if (point.attractor.kind == AttractorClass::aperiodic && !tangent_refusal(problem))
        point.attractor = by_tangents(problem, sampling, point, progress);
    if (point.attractor.kind != AttractorClass::chaotic) return point;
    const InitialState end = carried(problem, point.motion.end);
    const Sampling as_long_again = later(problem, sampling);
    const SampledMotion after = sample_by_run(problem, as_long_again, &end, progress);
    if (after.rested || !stays_chaotic(problem, after)) point.attractor.kind = AttractorClass::unsettled;
    return point;
}

}  // namespace

SweepPoint sweep_point(const Problem& problem, const Sampling& sampling, const InitialState* start,
                       const Progress& progress) {
    for (const Issue& finding : validate(problem))
        if (finding.fatal && !(start && finding.path.starts_with("initial")))
            throw std::invalid_argument(finding.path + ": " + finding.message);
    SweepPoint point = RigidMotion::applies(problem, sampling)
                           ? point_by_closed_forms(problem, sampling, start, progress)
                           : point_by_run(problem, sampling, start, progress);
    if (point.motion.over_the_top) point.motion.samples.clear();  // of no attractor
    return point;
}

Result motion_from(const Problem& problem, const InitialState& end, const Request& request, const Progress& progress) {
    const InitialState start = carried(problem, end);
    return std::move(Run(problem, {&request, 1}, progress, {.start = &start}).integrate().front());
}

}  // namespace beamcam::sim
