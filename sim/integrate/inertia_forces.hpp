// Generalized forces of inertia and gravity at the eight nodes of a step, for given accelerations (d'Alembert): the
// equations of motion without damping, bending, torque and contact. No inertia matrix is built or solved.
// MODEL.md §§4–5, §12.
#pragma once

#include <memory>

#include "sim/base/lanes.hpp"
#include "sim/beam/model.hpp"

namespace beamcam::sim {

// ξ, ξ̇, ξ̈ of all coordinates, and sine and cosine of ξ₀ = Θ.
struct NodalMotion {
    const Lanes *position, *rate, *acceleration;
    Lanes sin, cos;
};

class InertiaForces {
  public:
    static std::unique_ptr<InertiaForces> of(const Model& model, const Problem& problem);
    virtual ~InertiaForces() = default;
    // out ← d(∂T/∂ξ̇)/dt − ∂T/∂ξ + ∂V_g/∂ξ, one entry a coordinate.
    virtual void evaluate(const NodalMotion& motion, Lanes* out) = 0;
    // By how much bending changes the inertia about the hub, ∂²T/∂Θ̇², if the model has it: where the coupling with the
    // shapes leaves little of that inertia, the fixed-point iteration of the accelerations diverges without it.
    virtual Lanes hub_inertia_gain() const { return {}; }
};

}  // namespace beamcam::sim
