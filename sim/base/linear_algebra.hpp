// Dense linear systems and eigenproblems by Eigen, compiled in one file because each decomposition takes seconds.
#pragma once

#include <Eigen/Core>
#include <complex>

namespace beamcam::sim {

// Natural modes of a linear structure: K φ = ω² M φ, for symmetric K and positive definite M.
struct Eigenmodes {
    Eigen::VectorXd omega_squared;  // ascending [1/s²]; rounding may leave a rigid mode slightly below zero
    Eigen::MatrixXd shapes;         // in columns, mass-normalized: φᵀMφ = 1
};

// Source: the Cholesky–QL method of Eigen's GeneralizedSelfAdjointEigenSolver.
// Throws std::domain_error if M is not positive definite or the iteration does not converge.
Eigenmodes eigenmodes(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass);

// Eigenvalues of a square real matrix, in no order. These two are NaN where the matrix is not finite or the QR
// iteration does not converge.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);
// The eigenvector of unit length of the eigenvalue that is nearest to this number.
Eigen::VectorXcd eigenvector_nearest(const Eigen::MatrixXd& matrix, std::complex<double> number);

// x of A x = b by LU decomposition with complete pivoting; for a singular A some x, or not finite.
Eigen::VectorXd solve(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace beamcam::sim
