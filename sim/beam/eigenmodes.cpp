#include "sim/beam/eigenmodes.hpp"

#include <Eigen/Eigenvalues>
#include <stdexcept>

namespace beamcam::sim {

Eigenmodes eigenmodes(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, mass);
    if (solver.info() != Eigen::Success) throw std::domain_error("the natural modes of the beam cannot be computed");
    return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace beamcam::sim
