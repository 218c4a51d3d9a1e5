// A system of ordinary differential equations, and what ends its integration.
#pragma once

#include <stdexcept>

namespace beamcam::sim {

// y′ = f(t, y). The first `controlled` components take part in error control; the rest (work and
// impulse integrals) follow along and never change a step.
struct Ode {
    virtual ~Ode() = default;
    virtual void rhs(double t, const double* y, double* dy) = 0;
    int size = 0;
    int controlled = 0;
};

struct StepFailure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The inertia of the model, in the state that it is in, is not positive: no force has a definite answer.
struct InertiaLost : StepFailure {
    InertiaLost() : StepFailure("the inertia of the model is not positive") {}
};

}  // namespace beamcam::sim
