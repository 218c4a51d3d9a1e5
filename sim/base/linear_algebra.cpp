#include "sim/base/linear_algebra.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace beamcam::sim {

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
