// One point of a sweep: a motion, its samples and its class.
#pragma once

#include "sim/run/simulate.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::sim {

struct SweepPoint {
    SampledMotion motion;
    Attractor attractor;
};

// `start`: the end of another motion to go on from; null: the problem's own start. The fast path where it applies
// (rigid_motion.hpp), else the general integration. Throws Interrupted; std::invalid_argument when the problem is not
// valid.
SweepPoint sweep_point(const Problem& problem, const Sampling& sampling, const InitialState* start,
                       const Progress& progress);

// The motion that goes on from the end of another, of this or a neighbouring problem: at t = 0 the cam stands as it
// does at the problem's start, as it did at that end. Throws SolverError, Interrupted.
Result motion_from(const Problem& problem, const InitialState& end, const Request& request, const Progress& progress);

}  // namespace beamcam::sim
