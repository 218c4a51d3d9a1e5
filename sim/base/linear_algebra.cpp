#include "sim/base/linear_algebra.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <limits>
#include <stdexcept>

namespace beamcam::sim {

Eigenmodes eigenmodes(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass) {
    // Eigen's solver factors M too, but does not report a failure.
    const bool definite = is_positive_definite(mass);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, mass);
    if (!definite || solver.info() != Eigen::Success)
        throw std::domain_error("the natural modes of the beam cannot be computed");
    return {solver.eigenvalues(), solver.eigenvectors()};
}

namespace {
Eigen::VectorXcd not_found(Eigen::Index size) {
    return Eigen::VectorXcd::Constant(size, std::numeric_limits<double>::quiet_NaN());
}
}  // namespace

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix) {
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix, false);
    if (!matrix.allFinite() || solver.info() != Eigen::Success) return not_found(matrix.rows());
    return solver.eigenvalues();
}

Eigen::VectorXcd eigenvector_nearest(const Eigen::MatrixXd& matrix, std::complex<double> number) {
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix);
    if (!matrix.allFinite() || solver.info() != Eigen::Success) return not_found(matrix.rows());
    Eigen::Index nearest = 0;
    (solver.eigenvalues().array() - number).abs().minCoeff(&nearest);
    return solver.eigenvectors().col(nearest);
}

Eigen::VectorXd solve(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) { return a.fullPivLu().solve(b); }

Eigen::VectorXd null_vector(const Eigen::MatrixXd& rows) { return rows.fullPivLu().kernel().col(0); }

bool is_positive_definite(const Eigen::MatrixXd& symmetric) {
    return Eigen::LLT<Eigen::MatrixXd>(symmetric).info() == Eigen::Success;
}

Eigen::MatrixXd in_basis(const Eigen::MatrixXd& form, const Eigen::MatrixXd& basis) {
    return basis.transpose() * form * basis;
}

Eigen::MatrixXd weighted_square(const Eigen::MatrixXd& factor, const Eigen::VectorXd& weight) {
    return factor * weight.asDiagonal() * factor.transpose();
}

}  // namespace beamcam::sim
