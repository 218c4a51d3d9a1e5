#include "sim/sweep/sweep_point.hpp"

#include <algorithm>
#include <optional>

#include "sim/orbit/exponents.hpp"
#include "sim/run/run.hpp"
#include "sim/sweep/rigid_motion.hpp"
#include "sim/sweep/sampler.hpp"

namespace beamcam::sim {
namespace {

constexpr long kLaterTurns = 1000;  // in which a chaotic motion may settle: milliseconds by closed forms

// The motion goes on for as long as its samples were taken, with its largest exponent. The cam stands then where it
// stood at the start: samples are taken over whole turns.
Attractor by_tangents(const Problem& problem, const Sampling& sampling, const SweepPoint& point,
                      const Progress& progress) {
    const SampleSpan span = sample_span(problem, sampling);
    ExponentsRequest request;
    request.duration = static_cast<double>(span.kept()) * cam_period(problem);
    request.start = carried(problem, point.motion.end);
    try {
        const Exponents found = lyapunov_exponents(problem, request, progress);
        if (found.lambda.empty()) return point.attractor;  // a rigid beam on a prescribed hub has no neighbours
        const double late = found.settled ? found.lambda.front() * found.duration / 2 : kNan;
        return with_exponent(problem, point.attractor, {found.lambda.front(), found.error.front(), late});
    } catch (const SolverError&) {
        return point.attractor;  // its exponent stays unknown
    }
}

// From the problem's start, or from that of `start`, as `carried` moves it.
SampledMotion sampled_motion(const Problem& problem, const Sampling& sampling, const InitialState* start,
                             const Progress& progress) {
    if (RigidMotion::applies(problem, sampling)) return RigidMotion(problem, sampling, start).follow(progress);
    std::optional<InitialState> moved;
    if (start) moved = carried(problem, *start);
    return sample_by_run(problem, sampling, moved ? &*moved : nullptr, progress);
}

// A chaotic motion that is followed for as long again as until now still has no period.                     (S89a)
bool stays_chaotic(const Problem& problem, const Sampling& sampling, const SampledMotion& motion,
                   const Progress& progress) {
    const SampleSpan span = sample_span(problem, sampling);
    const bool closed = RigidMotion::applies(problem, sampling);
    Sampling later = sampling;
    later.keep = {static_cast<double>(span.kept()), {}};
    later.transient = {static_cast<double>(std::max(span.from, (closed ? kLaterTurns : 0) - span.kept())), {}};
    SampledMotion rest;
    if (closed) {
        RigidMotion followed(problem, later, &motion.end);
        rest = followed.follow(progress);
        if (followed.rested()) return false;
    } else {
        rest = sampled_motion(problem, later, &motion.end, progress);
    }
    if (classify(problem, rest).kind == AttractorClass::chaotic) return true;
    // The exponent of other turns may be less sure: what counts is that nothing returns.
    for (Strobe& strobe : rest.strobes) strobe.growth = kNan;
    return classify(problem, rest).kind == AttractorClass::aperiodic;
}

}  // namespace

SweepPoint sweep_point(const Problem& problem, const Sampling& sampling, const InitialState* start,
                       const Progress& progress) {
    for (const Finding& finding : validate(problem))
        if (finding.fatal && !(start && finding.path.starts_with("initial")))
            throw std::invalid_argument(finding.path + ": " + finding.message);
    SweepPoint point;
    point.motion = sampled_motion(problem, sampling, start, progress);
    if (point.motion.over_the_top) point.motion.samples.clear();  // of no attractor
    point.attractor = classify(problem, point.motion);
    if (point.attractor.kind == AttractorClass::aperiodic && !exponents_refusal(problem))
        point.attractor = by_tangents(problem, sampling, point, progress);
    if (point.attractor.kind == AttractorClass::chaotic && !stays_chaotic(problem, sampling, point.motion, progress))
        point.attractor.kind = AttractorClass::unsettled;
    return point;
}

Result motion_from(const Problem& problem, const InitialState& end, const Request& request, const Progress& progress) {
    const InitialState start = carried(problem, end);
    return std::move(Run(problem, {&request, 1}, progress, {.start = &start}).integrate().front());
}

}  // namespace beamcam::sim
