// A system of ordinary differential equations, and the failures of its integration.
#pragma once

#include <limits>
#include <stdexcept>

namespace beamcam::sim {

// y′ = f(t, y). Error control sees the first `controlled` components; the rest (work and impulse integrals) never
// change a step, unless the motion is given. `longest_step`: f may change in it unseen by a method that evaluates it
// once in a step [s].
struct Ode {
    virtual ~Ode() = default;
    virtual void rhs(double t, const double* y, double* dy) = 0;
    int size = 0;
    int controlled = 0;
    double longest_step = std::numeric_limits<double>::infinity();
};

struct StepFailure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The inertia of the model is not positive in this state: the accelerations are not determined.
struct InertiaLost : StepFailure {
    InertiaLost() : StepFailure("the inertia of the model is not positive") {}
};

// Friction presses the beam into the cam by more than the contact force pushes it off: no force ends the contact.
struct ContactLocked : StepFailure {
    ContactLocked() : StepFailure("the equations of the impact have no solution") {}
};

}  // namespace beamcam::sim
