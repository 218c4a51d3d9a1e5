// Models that project d'Alembert's principle at Gauss nodes, without terms expanded by hand: `second-order` and
// `exact`. Inertia and forces are sums over the nodes; each right-hand side needs one dense factorization. MODEL.md §5.
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "sim/base/numerics.hpp"
#include "sim/beam/model.hpp"

namespace beamcam::sim {

// The projection of columns c = ∂r/∂ξ and of the acceleration at ξ̈ = 0. At each node both are multiplied by √(ρAw).
//   M = ρA Σ w cᵀc + I_h hᵀh,   f = −ρA Σ w cᵀ(r̈|ξ̈=0 + g) − Kq − C_d q̇           (S16)
class QuadratureModel : public Model {
  public:
    bool assemble(double* f) override;
    void solve(double* f) const override;
    double solve_held(double* f, double hub) const override;
    Linearization linearize() const override;
    double frequency(int i) const override { return frequencies_[static_cast<std::size_t>(i)]; }
    Energies energies() const override;

  protected:
    QuadratureModel(const Problem& problem, int nodes);
    QuadratureModel(const QuadratureModel&) = default;
    // The derived class's constructor ends with this: natural frequencies and damping.
    void finish(const Problem& problem);

    using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxSize, kMaxSize>;
    // columns_ ← ∂r/∂ξ and bias_ ← r̈|ξ̈=0 plus gravity at the nodes, times √(ρAw): all x components, then all y.
    virtual void columns() = 0;
    // y_ ← height; vx_, vy_ ← velocity, at the nodes.
    virtual void node_kinematics() const = 0;

    Quadrature rule_;
    SpectralIntegral integral_;
    Eigen::MatrixXd primitive_;    // ∫₀ to each node
    Eigen::MatrixXd bending_;      // EI∫ of curvature products
    bool angular_ = false;         // coordinates are angles
    Eigen::VectorXd root_weight_;  // √(ρAw)
    Eigen::MatrixXd columns_;
    Eigen::VectorXd bias_;
    mutable Eigen::VectorXd y_, vx_, vy_, scratch_;
    Small inertia_;
    Eigen::LDLT<Small> factor_;
    std::vector<double> frequencies_;  // [rad/s], ascending
};

}  // namespace beamcam::sim
