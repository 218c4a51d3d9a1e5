#include "sim/sweep/sweep_point.hpp"

#include <optional>

#include "sim/sweep/rigid_motion.hpp"
#include "sim/sweep/sampler.hpp"

namespace beamcam::sim {

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
    return point;
}

}  // namespace beamcam::sim
