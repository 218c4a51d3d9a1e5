#include "sim/sweep/sweep_point.hpp"

#include <optional>

#include "sim/orbit/exponents.hpp"
#include "sim/run/run.hpp"
#include "sim/sweep/rigid_motion.hpp"
#include "sim/sweep/sampler.hpp"

namespace beamcam::sim {
namespace {

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
        Attractor judged =
            with_exponent(problem, point.attractor, {found.lambda.front(), found.error.front(), found.grows_late()});
        if (found.chaos() == Chaos::doubtful) judged.kind = AttractorClass::aperiodic;
        return judged;
    } catch (const SolverError&) {
        return point.attractor;  // its exponent stays unknown
    }
}

}  // namespace

SweepPoint sweep_point(const Problem& problem, const Sampling& sampling, const InitialState* start,
                       const Progress& progress) {
    for (const Finding& finding : validate(problem))
        if (finding.fatal && !(start && finding.path.starts_with("initial")))
            throw std::invalid_argument(finding.path + ": " + finding.message);
    SweepPoint point;
    if (RigidMotion::applies(problem, sampling)) {
        point.motion = RigidMotion(problem, sampling, start).follow(progress);
    } else {
        std::optional<InitialState> moved;
        if (start) moved = carried(problem, *start);
        point.motion = sample_by_run(problem, sampling, moved ? &*moved : nullptr, progress);
    }
    if (point.motion.over_the_top) point.motion.samples.clear();  // of no attractor
    point.attractor = classify(problem, point.motion);
    if (point.attractor.kind == AttractorClass::aperiodic && !exponents_refusal(problem))
        point.attractor = by_tangents(problem, sampling, point, progress);
    return point;
}

Result motion_from(const Problem& problem, const InitialState& end, const Request& request, const Progress& progress) {
    const InitialState start = carried(problem, end);
    return std::move(Run(problem, {&request, 1}, progress, {.start = &start}).integrate().front());
}

}  // namespace beamcam::sim
