#include "sim/sweep/sweep_point.hpp"

#include "sim/orbit/exponents.hpp"
#include "sim/sweep/rigid_motion.hpp"
#include "sim/sweep/sampler.hpp"

namespace beamcam::sim {
namespace {

// Turns of the cam in which the tangent aligns with the direction of largest growth.
constexpr double kWarmUp = 20;

// Continues the motion, with a tangent, for as many turns as its samples take. Samples cover whole turns, so the cam
// has its initial phase again.                                                                                   (S89)
void add_exponent(const Problem& problem, const Sampling& sampling, SweepPoint& point, const Progress& progress) {
    const double turn = cam_period(problem);
    ExponentsRequest request;
    request.transient = kWarmUp * turn;
    request.duration = static_cast<double>(sample_span(problem, sampling).kept()) * turn;
    request.start = carried(problem, point.motion.end);
    try {
        Exponents found = lyapunov_exponents(problem, request, progress);
        if (found.lambda.empty()) return;  // a rigid beam on a prescribed hub has no tangents
        confirm_chaos(problem, request, found, progress);
        Attractor& attractor = point.attractor;
        if (attractor.period > 0 && found.diverges()) return;  // the continued motion has left the orbit
        attractor.exponent = found.lambda.front();
        attractor.exponent_error = found.error.front();
        if (attractor.period == 0 && found.chaotic()) attractor.kind = AttractorClass::chaotic;
    } catch (const SolverError&) {
        // The exponent remains unknown.
    }
}

SampledMotion sampled_motion(const Problem& problem, const Sampling& sampling, const InitialState* start,
                             const Progress& progress) {
    if (RigidMotion::applies(problem, sampling)) return RigidMotion(problem, sampling, start).follow(progress);
    if (!start) return sample_by_run(problem, sampling, nullptr, progress);
    const InitialState moved = carried(problem, *start);
    return sample_by_run(problem, sampling, &moved, progress);
}

}  // namespace

SweepPoint sweep_point(const Problem& problem, const Sampling& sampling, const InitialState* start,
                       const Progress& progress) {
    for (const Issue& finding : validate(problem))
        if (finding.fatal && !(start && finding.path.starts_with("initial")))
            throw std::invalid_argument(finding.path + ": " + finding.message);
    SweepPoint point;
    point.motion = sampled_motion(problem, sampling, start, progress);
    point.attractor = classify(problem, point.motion);
    if (sampling.exponents && point.motion.has_end()) add_exponent(problem, sampling, point, progress);
    if (point.motion.over_the_top) point.motion.samples.clear();  // of no attractor
    return point;
}

}  // namespace beamcam::sim
