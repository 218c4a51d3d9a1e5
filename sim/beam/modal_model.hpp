// Models that are quadratic in modal coordinates: rigid, zeroth-order, first-order and the paper's eq. (4). Their
// matrices are constant and computed once by quadrature. The inertia is a multiple of the identity, bordered by one row
// and column, so the right-hand side needs no factorization. MODEL.md §4.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "sim/base/numerics.hpp"
#include "sim/beam/model.hpp"
#include "sim/beam/shapes.hpp"

namespace beamcam::sim {

// The integrals of MODEL.md (S8)–(S12) over a set of shapes.
struct ModalMatrices {
    double J = 0;                // I_h + ρA∫(a+x)² [kg m²]
    double S = 0;                // ρA∫(a+x) [kg m]
    Eigen::VectorXd U, W;        // ρA∫(a+x)φ [kg m], ρA∫φ [kg]
    Eigen::VectorXd K;           // EI∫φ″², diagonal [N/m]
    Eigen::MatrixXd M, D, G;     // ρA∫φφᵀ, stiffening, gravity [kg], [kg], [kg/m]
    Eigen::MatrixXd P0, P1, P2;  // ρA∫x^k φ′φ′ᵀ, only for the model `paper` (S15)
    Eigen::VectorXd slope;       // φ′(0)
};
ModalMatrices modal_matrices(const Problem& problem, const Shapes& shapes, Basis basis);

class ModalModel final : public Model {
  public:
    explicit ModalModel(const Problem& problem);
    std::unique_ptr<Model> clone() const override { return std::make_unique<ModalModel>(*this); }

    bool assemble(double* f) override;
    void solve(double* f) const override;
    double solve_held(double* f, double hub) const override;
    void point(double x, BeamPoint& p) const override;
    void jacobian(double x, double* jx, double* jy, double* jchi) const override;
    Vec2 convective(double x) const override;
    double bending_moment(double x) const override;
    Energies energies() const override;
    void linearize(double* mass, double* stiffness, double* centrifugal) const override;
    double frequency(int i) const override;

    // ---- for integrators that use the form of the equations ----
    ModelKind kind() const { return kind_; }
    bool coupled() const { return coupled_; }  // U ≠ 0
    bool foreshortening() const;
    const ModalMatrices& matrices() const;
    const Eigen::MatrixXd& inertia_matrix() const;  // B of (S14)
    const Shapes& shapes() const;
    // H(x) = ∫₀ˣφ′φ′ᵀ (S5a), column-major N².
    void shortening_matrix(double x, double* h) const;

  private:
    struct Tables;
    // The shapes at one x and H(x)q, cached because `point` and `jacobian` both need them.
    struct Local {
        double x = -1;
        double y[kMaxModes], y1[kMaxModes], y2[kMaxModes], y3[kMaxModes];
        bool shortened = false;             // `shortening` is that of the present state
        double shortening[kMaxModes] = {};  // H(x) q (S5a)
    };
    void state_changed() override;
    const Local& at(double x) const;
    void shorten(Local& here) const;
    void shorten(const Local& here, const double* q, double* hq) const;  // hq ← H(x) q

    ModelKind kind_;
    std::shared_ptr<const Tables> tables_;
    bool coupled_;  // U ≠ 0
    double sin_ = 0, cos_ = 1;
    double inertia_ = 1;                // J + qᵀ(M − D)q
    double alpha_ = 0, alpha_dot_ = 0;  // of the hub relative to the frame (S13)
    mutable Eigen::VectorXd bq_, gq_;   // scratch
    mutable Local local_, root_, tip_;  // at the last x, and at the two ends
};

}  // namespace beamcam::sim
