// Generalized forces of inertia and gravity of the model `exact` at the eight nodes of a step, for given accelerations
// (d'Alembert): the equations of motion without damping, bending, torque and contact. No inertia matrix is built or
// solved. MODEL.md §5, §12.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/lanes.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// ξ, ξ̇, ξ̈ of the coordinates: the rate and acceleration of the first, and all of the others; sine and cosine of Θ.
struct NodalMotion {
    Lanes turn_rate, turn_acceleration;
    const Lanes *position, *rate, *acceleration;
    Lanes sin, cos;
};

// (S18), (S19) in the frame of the hub: the section's angle against it is δ = Σ q_j η_j, and the force on q_j is
// ∫η_j (cos δ F_y − sin δ F_x), F the integral of ρA(r̈ + g) from x to the tip.
class InertiaForces {
  public:
    explicit InertiaForces(const Problem& problem);
    // out ← d(∂T/∂ξ̇)/dt − ∂T/∂ξ + ∂V_g/∂ξ, one entry a coordinate.
    void evaluate(const NodalMotion& motion, Lanes* out);

  private:
    // A constant matrix times numbers in lanes.
    class LaneMatrix {
      public:
        LaneMatrix() = default;
        explicit LaneMatrix(const Eigen::MatrixXd& m);
        void times(const Lanes* x, Lanes* y) const { product(rows_, columns_, numbers_.data(), x, y); }

      private:
        std::size_t rows_ = 0, columns_ = 0;
        std::vector<double> numbers_;
    };

    double radius_, hub_inertia_, gravity_, mass_ = 0;
    Eigen::VectorXd mass_beyond_;  // of the part of the beam beyond a quadrature node
    LaneMatrix double_integral_;  // PᵀWP, P the matrix of ∫₀ˣ to the quadrature nodes and W that of their masses
    LaneMatrix shapes_, shapes_transposed_;
    std::vector<Lanes> sin_, cos_, rate_, bend_, x_, y_;
};

}  // namespace beamcam::sim
