#include <Eigen/Eigenvalues>
#include <stdexcept>

#include "sim/base/linear_algebra.hpp"

namespace beamcam::sim {

Eigenmodes eigenmodes(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass) {
    // Eigen's solver factors M too, but does not report a failure.
    const bool definite = is_positive_definite(mass);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, mass);
    if (!definite || solver.info() != Eigen::Success)
        throw std::domain_error("the natural modes of the beam cannot be computed");
    return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace beamcam::sim
