// Models that are quadratic in modal coordinates: rigid, zeroth-order, first-order and the paper's eq. (4). Their
// matrices are constant and computed once by quadrature. The inertia is a multiple of the identity, bordered by one row
// and column, so the right-hand side needs no factorization. MODEL.md §4.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "sim/beam/foreshortening.hpp"
#include "sim/beam/modal_matrices.hpp"
#include "sim/beam/model.hpp"
#include "sim/beam/shapes.hpp"

namespace beamcam::sim {

class ModalModel final : public Model {
  public:
    explicit ModalModel(const Problem& problem);
    std::unique_ptr<Model> clone() const override { return std::make_unique<ModalModel>(*this); }

    bool assemble(double* f) override;
    void solve(double* f) const override;
    double solve_held(double* f, double hub) const override;
    void keep(const Eigen::VectorXd& x) override;
    void point(double x, BeamPoint& p) const override;
    void jacobian(double x, double* jx, double* jy, double* jchi) const override;
    Vec2 convective(double x) const override;
    double bending_moment(double x) const override;
    Energies energies() const override;
    Linearization linearize() const override;
    double frequency(int i) const override;

    // ---- for integrators that use the form of the equations ----
    ModelKind kind() const { return kind_; }
    bool coupled() const { return coupled_; }  // U ≠ 0
    bool foreshortening() const { return tables_->foreshortening.has_value(); }
    const ModalMatrices& matrices() const { return tables_->m; }
    const Eigen::MatrixXd& inertia_matrix() const { return tables_->B; }
    const Shapes& shapes() const { return tables_->shapes; }
    // H(x) of a model with foreshortening, column-major N².
    void shortening_matrix(double x, double* h) const;

  private:
    // Values that do not depend on the state are shared by clones.
    struct Tables {
        ModalMatrices m;
        Eigen::MatrixXd B;  // (S14): M − D, or M without foreshortening
        Shapes shapes;
        std::optional<Foreshortening> foreshortening;
    };
    // Cached because `point` and `jacobian` both need them.
    struct Local : ShapesAt {
        long state = -1;                    // the number of the state that `shortening` belongs to
        double shortening[kMaxModes] = {};  // H(x) q (S5a)
        Eigen::MatrixXd h;                  // H(x) of a place that is kept
    };
    void state_changed() override;
    const Local& at(double x) const;
    void shorten(const Local& here, const double* q, double* hq) const;  // hq ← H(x) q

    ModelKind kind_;
    std::shared_ptr<const Tables> tables_;
    bool coupled_;  // U ≠ 0
    double sin_ = 0, cos_ = 1;
    double inertia_ = 1;                // J + qᵀ(M − D)q
    double alpha_ = 0, alpha_dot_ = 0;  // of the hub relative to the frame (S13)
    long state_ = 0;                    // the number of the present state
    mutable Eigen::VectorXd bq_, gq_;   // Bq, and Gq or, of `paper`, Mq less the stiffening of (S15)
    mutable std::vector<Local> kept_;   // by rising x, with both ends
    mutable Local elsewhere_;           // at the last other x
};

}  // namespace beamcam::sim
