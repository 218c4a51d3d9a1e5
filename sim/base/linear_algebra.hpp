// Products, linear systems and eigenproblems of dense matrices by Eigen, in few files because each takes seconds to
// compile.
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

// A vector that all rows are orthogonal to, of no particular length.
Eigen::VectorXd null_vector(const Eigen::MatrixXd& rows);

bool is_positive_definite(const Eigen::MatrixXd& symmetric);

Eigen::MatrixXd in_basis(const Eigen::MatrixXd& form, const Eigen::MatrixXd& basis);            // BᵀFB
Eigen::MatrixXd weighted_square(const Eigen::MatrixXd& factor, const Eigen::VectorXd& weight);  // F·diag(w)·Fᵀ

}  // namespace beamcam::sim
