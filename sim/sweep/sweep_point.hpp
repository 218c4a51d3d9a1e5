// One point of a sweep: a motion, its samples and its class.
#pragma once

#include "sim/run/simulate.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::sim {

struct SweepPoint {
    SampledMotion motion;
    Attractor attractor;
};

// `start`: the end of another motion; null: the problem's own start. Uses the closed forms where they apply
// (rigid_motion.hpp), else a Run. Exponents, if they are asked for, are those of lyapunov_exponents. Throws
// Interrupted; std::invalid_argument for an invalid problem, and for exponents of one without tangents.
SweepPoint sweep_point(const Problem& problem, const Sampling& sampling, const InitialState* start,
                       const Progress& progress);

}  // namespace beamcam::sim
