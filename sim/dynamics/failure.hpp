// Why a run could not go on, in the terms of who wrote the scene: the cause with its numbers, and what to change.
#pragma once

#include <string>

#include "sim/dynamics/system.hpp"

namespace beamcam::sim {

enum class Stop {
    steps_spent,   // solver.max_steps
    too_slow,      // at the pace of the last steps, far more than solver.max_steps would be needed
    inertia_lost,  // the model's inertia is no longer positive
    passed_cam,    // the beam was pressed over the middle of the disc
    stuck,         // events without time passing
    method         // the integrator's own reason: `words`
};

// Ends a run for a reason of its own, not the integrator's.
struct RunStopped : StepFailure {
    RunStopped(Stop reason, const char* what) : StepFailure(what), why(reason) {}
    Stop why;
};

struct Failure {
    Stop why = Stop::method;
    std::string words;     // of the integrator
    double t = 0;          // the last good instant [s]
    double last_step = 0;  // the last accepted step before it [s]
    double whole = 0;      // steps that the whole run would take at this pace, for `too_slow`
};

// `system` is in the phase of the last good instant, `y` the state there.
std::string explain(const Failure& failure, System& system, const double* y);

}  // namespace beamcam::sim
