#include <Eigen/Eigenvalues>
#include <limits>

#include "sim/base/linear_algebra.hpp"

namespace beamcam::sim {
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

}  // namespace beamcam::sim
