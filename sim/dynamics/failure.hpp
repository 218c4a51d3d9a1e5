// The message of a run that could not be completed: cause, numbers and remedy, in terms of the scene.
#pragma once

#include <string>

#include "sim/dynamics/system.hpp"

namespace beamcam::sim {

enum class Stop {
    steps_spent,   // solver.max_steps
    too_slow,      // at the present step size the run needs far more than solver.max_steps
    inertia_lost,  // the model's inertia is no longer positive
    passed_cam,    // the beam was pressed over the centre of the disc
    locked,        // friction presses the beam into the cam
    stuck,         // events follow each other without progress in time
    refused,       // the tangents of the motion are not known: `message`
    method         // the integrator failed: `message`
};

// Thrown by a run or its tangents, not by the integrator.
struct RunStopped : StepFailure {
    RunStopped(Stop reason, const char* what) : StepFailure(what), why(reason) {}
    Stop why;
};

struct Failure {
    Stop why = Stop::method;
    std::string message;         // of the exception
    double t = 0;                // last good instant [s]
    double last_step = 0;        // last accepted step before it [s]
    double projected_steps = 0;  // steps of the whole run at the present step size, for `too_slow`
};

// `system` must be in the phase of the last good instant; `y` is the state there.
std::string explain(const Failure& failure, System& system, const double* y);

}  // namespace beamcam::sim
