#include "sim/beam/exact_model.hpp"

#include <cmath>

#include "sim/base/assert.hpp"
#include "sim/beam/quadrature_model.hpp"

namespace beamcam::sim {
namespace {

// Section angle ψ(x) = θ + Σ q_j η_j(x) with shifted Legendre polynomials η_j = P_j(2x/L − 1) − P_j(−1), so that the
// hub angle is the first coordinate. r = a e(θ) + ∫₀ˣ e(ψ)                                    (S18)
class ExactModel final : public QuadratureModel {
  public:
    explicit ExactModel(const Problem& problem) : QuadratureModel(problem, exact_nodes(problem)) {
        angular_ = true;
        const Eigen::Index nodes = rule_.x.size();
        eta_.resize(nodes, modes_);
        bending_ = Eigen::MatrixXd::Zero(modes_, modes_);
        for (Eigen::Index k = 0; k < nodes; ++k) {
            const AngleShapes shapes(*this, rule_.x[k]);
            for (int i = 0; i < modes_; ++i) {
                eta_(k, i) = shapes.value[i];
                for (int j = 0; j < modes_; ++j)
                    bending_(i, j) += stiffness_ * rule_.w[k] * shapes.slope[i] * shapes.slope[j];
            }
        }
        for (Eigen::VectorXd* v : {&cos_, &sin_, &psi_dot_, &weights_}) v->resize(nodes);
        integrands_.resize(nodes, 2 * (size_ + 1));
        integrated_.resize(nodes, 2 * (size_ + 1));
        weighted_primitive_ = root_weight_.asDiagonal() * primitive_;
        finish(problem);
    }
    std::unique_ptr<Model> clone() const override { return std::make_unique<ExactModel>(*this); }

    void point(double x, BeamPoint& p) const override {
        const AngleShapes shapes(*this, x);
        double psi = xi_[0], psi_rate = rate_[0], curvature = 0;
        for (int i = 0; i < modes_; ++i) {
            psi += shapes.value[i] * xi_[1 + i];
            psi_rate += shapes.value[i] * rate_[1 + i];
            curvature += shapes.slope[i] * xi_[1 + i];
        }
        weigh(x);
        const Vec2 e = unit(psi), root = unit(xi_[0]);
        p.r = radius_ * root + Vec2{weights_.dot(cos_), weights_.dot(sin_)};
        p.r1 = e;
        p.r2 = curvature * perp(e);
        p.v = radius_ * rate_[0] * perp(root) +
              Vec2{-weights_.dot(sin_.cwiseProduct(psi_dot_)), weights_.dot(cos_.cwiseProduct(psi_dot_))};
        p.v1 = psi_rate * perp(e);
    }

    void jacobian(double x, double* jx, double* jy, double* jchi) const override {
        const AngleShapes shapes(*this, x);
        weigh(x);
        const Vec2 root = perp(unit(xi_[0]));
        jx[0] = radius_ * root.x - weights_.dot(sin_);
        jy[0] = radius_ * root.y + weights_.dot(cos_);
        jchi[0] = 1;
        for (int i = 0; i < modes_; ++i) {
            double sx = 0, sy = 0;
            for (Eigen::Index k = 0; k < eta_.rows(); ++k) {
                sx -= weights_[k] * sin_[k] * eta_(k, i);
                sy += weights_[k] * cos_[k] * eta_(k, i);
            }
            jx[1 + i] = sx;
            jy[1 + i] = sy;
            jchi[1 + i] = shapes.value[i];
        }
    }

    Vec2 convective(double x) const override {
        weigh(x);
        const Vec2 inner{weights_.dot(cos_.cwiseProduct(psi_dot_.cwiseAbs2())),
                         weights_.dot(sin_.cwiseProduct(psi_dot_.cwiseAbs2()))};
        return -radius_ * rate_[0] * rate_[0] * unit(xi_[0]) - inner;  // (S19)
    }

    double bending_moment(double x) const override {
        const AngleShapes shapes(*this, x);
        double curvature = 0;
        for (int i = 0; i < modes_; ++i) curvature += shapes.slope[i] * xi_[1 + i];
        return stiffness_ * curvature;
    }

  private:
    // weights_ ← quadrature weights of ∫₀ˣ.
    void weigh(double x) const {
        if (x == weighed_) return;
        weighed_ = x;
        integral_.weights(x, weights_.data());
    }

    // The shapes η_j and their slopes at x, j = 1…N.
    struct AngleShapes {
        AngleShapes(const ExactModel& of, double x) : slope(value + of.modes_) {
            section_angle_shapes(x, of.length_, of.modes_, 1, value);
        }
        double value[2 * kMaxModes];
        const double* slope;
    };

    void state_changed() override {
        const Eigen::Map<const Eigen::VectorXd> q(xi_ + 1, modes_), dq(rate_ + 1, modes_);
        scratch_.noalias() = eta_ * q;
        psi_dot_.noalias() = eta_ * dq;
        psi_dot_.array() += rate_[0];
        for (Eigen::Index k = 0; k < scratch_.size(); ++k) {
            cos_[k] = std::cos(xi_[0] + scratch_[k]);
            sin_[k] = std::sin(xi_[0] + scratch_[k]);
        }
    }

    void columns() override {
        const Vec2 root = unit(xi_[0]);
        const Eigen::Index nodes = rule_.x.size(), half = size_ + 1;
        // r̈ at ξ̈ = 0: −aθ̇² e(θ) − ∫ψ̇² e(ψ)                                               (S19)
        scratch_ = psi_dot_.cwiseAbs2();
        integrands_.col(0) = -sin_;
        integrands_.col(half) = cos_;
        integrands_.col(half - 1) = -scratch_.cwiseProduct(cos_);
        integrands_.col(2 * half - 1) = -scratch_.cwiseProduct(sin_);
        for (int i = 0; i < modes_; ++i) {
            integrands_.col(1 + i) = -sin_.cwiseProduct(eta_.col(i));
            integrands_.col(half + 1 + i) = cos_.cwiseProduct(eta_.col(i));
        }
        integrated_.noalias() = weighted_primitive_ * integrands_;
        columns_.topRows(nodes) = integrated_.leftCols(size_);
        columns_.bottomRows(nodes) = integrated_.middleCols(half, size_);
        columns_.col(0).head(nodes) -= radius_ * root.y * root_weight_;
        columns_.col(0).tail(nodes) += radius_ * root.x * root_weight_;
        const double pull = radius_ * rate_[0] * rate_[0];
        bias_.head(nodes) = integrated_.col(half - 1) - pull * root.x * root_weight_;
        bias_.tail(nodes) = integrated_.col(2 * half - 1) + (gravity_ - pull * root.y) * root_weight_;
    }

    void node_kinematics() const override {
        const Vec2 root = unit(xi_[0]);
        y_.noalias() = primitive_ * sin_;
        y_.array() += radius_ * root.y;
        scratch_ = psi_dot_.cwiseProduct(sin_);
        vx_.noalias() = -(primitive_ * scratch_);
        vx_.array() -= radius_ * rate_[0] * root.y;
        scratch_ = psi_dot_.cwiseProduct(cos_);
        vy_.noalias() = primitive_ * scratch_;
        vy_.array() += radius_ * rate_[0] * root.x;
    }

    Eigen::MatrixXd eta_;
    mutable Eigen::VectorXd weights_;
    mutable double weighed_ = -1;                                   // x of weights_
    Eigen::MatrixXd weighted_primitive_, integrands_, integrated_;  // columns and bias of x, then of y
    Eigen::VectorXd cos_, sin_, psi_dot_;
};

}  // namespace

// Sine and cosine of the section angle are smoother than products of four shapes.
int exact_nodes(const Problem& problem) { return 2 * problem.beam.modes + 24; }

void section_angle_shapes(double x, double length, int count, int order, double* values) {
    double p[(kMaxShapeOrder + 1) * (kMaxModes + 1)], scale = 1;
    BEAMCAM_ASSERT(order <= kMaxShapeOrder);
    legendre(2 * x / length - 1, count + 1, order + 1, p);
    for (int j = 1; j <= count; ++j) values[j - 1] = p[j] - (j % 2 ? -1.0 : 1.0);
    for (int m = 1; m <= order; ++m) {
        scale *= 2 / length;
        for (int j = 1; j <= count; ++j) values[m * count + j - 1] = scale * p[m * (count + 1) + j];
    }
}

std::unique_ptr<Model> make_exact_model(const Problem& problem) { return std::make_unique<ExactModel>(problem); }

}  // namespace beamcam::sim
