// Natural modes of a linear structure: K φ = ω² M φ, for symmetric K and positive definite M.
#pragma once

#include <Eigen/Core>

namespace beamcam::sim {

struct Eigenmodes {
    Eigen::VectorXd omega_squared;  // ascending [1/s²]; rounding may leave a rigid mode slightly below zero
    Eigen::MatrixXd shapes;         // in columns, mass-normalized: φᵀMφ = 1
};

// Source: the Cholesky–QL method of Eigen's GeneralizedSelfAdjointEigenSolver.
// Throws std::domain_error if M is not positive definite or the iteration does not converge.
Eigenmodes eigenmodes(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass);

}  // namespace beamcam::sim
