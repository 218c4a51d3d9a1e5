// The natural modes of the straight beam with its hub: vibrations about the mean rigid rotation of a free hub, or of
// the beam on a hub that is held. Each has the modal mass m of the beam. MODEL.md §12.
#pragma once

#include <Eigen/Core>

#include "sim/beam/model.hpp"

namespace beamcam::sim {

struct NaturalModes {
    // Throws InertiaLost and std::domain_error where the straight beam has no positive inertia.
    NaturalModes(const Model& of, const Problem& problem);

    // ξ = shapes z, z = inverse ξ; z₀ is the rigid rotation.
    Eigen::MatrixXd shapes, inverse;
    Eigen::VectorXd omega_squared;  // of z₁…z_n, ascending [1/s²]
    Eigen::VectorXd damping;        // 2γ of z₁…z_n [1/s]; no damping law couples them
    double J = 0, S = 0;            // inertia [kg m²] and static moment [kg m] about the hinge
    Eigen::VectorXd U, weight;      // inertia shared with z₀, zero for a free hub [kg m]; W/m of gravity

  private:
    void weigh(Model& model, double gravity);
};

}  // namespace beamcam::sim
