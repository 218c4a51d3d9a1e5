#include "sim/beam/second_order_model.hpp"

#include <algorithm>
#include <cmath>

#include "sim/beam/modal_model.hpp"
#include "sim/beam/quadrature_model.hpp"

namespace beamcam::sim {
namespace {

// Frame coordinates: r = (a + x + u, v), u = −½∫v′² − ½aα² (S5), (S13), so the kinematics are those of `first-order`.
class SecondOrderModel final : public QuadratureModel {
  public:
    explicit SecondOrderModel(const Problem& problem)
        : QuadratureModel(problem, second_order_nodes(problem)), line_(first_order(problem)) {
        const Eigen::Index nodes = rule_.x.size();
        phi_.resize(nodes, modes_);
        phi1_.resize(nodes, modes_);
        bending_ = line_.matrices().K.asDiagonal();
        Eigen::VectorXd y(modes_), y1(modes_);
        for (Eigen::Index k = 0; k < nodes; ++k) {
            line_.shapes().evaluate(rule_.x[k], y.data(), y1.data(), nullptr);
            phi_.row(k) = y.transpose();
            phi1_.row(k) = y1.transpose();
        }
        line_.keep(rule_.x);
        std::copy_n(line_.hub_row(), size_, hub_row_);
        for (Eigen::VectorXd* v : {&v_, &dv_, &u_, &du_}) v->resize(nodes);
        shortening_.resize(nodes * modes_, modes_);
        for (int i = 0; i < modes_; ++i)
            shortening_.middleRows(i * nodes, nodes).noalias() =
                -primitive_ * (phi1_.array().colwise() * phi1_.col(i).array()).matrix();
        shortened_.resize(nodes, modes_);
        columns_.bottomRightCorner(nodes, modes_) = root_weight_.asDiagonal() * phi_;
        finish(problem);
    }
    std::unique_ptr<Model> clone() const override { return std::make_unique<SecondOrderModel>(*this); }

    void point(double x, BeamPoint& p) const override { line_.point(x, p); }
    void jacobian(double x, double* jx, double* jy, double* jchi) const override { line_.jacobian(x, jx, jy, jchi); }
    Vec2 convective(double x) const override { return line_.convective(x); }
    double bending_moment(double x) const override { return line_.bending_moment(x); }

  private:
    static Problem first_order(Problem problem) {
        problem.beam.basis = resolved_basis(problem);
        problem.beam.model = ModelKind::first_order;
        problem.beam.damping_ratio.clear();
        problem.beam.kelvin_voigt.reset();
        return problem;
    }

    void state_changed() override { line_.set(xi_, rate_); }

    void columns() override {
        const Eigen::Map<const Eigen::VectorXd> q(xi_ + 1, modes_), dq(rate_ + 1, modes_), h(hub_row_ + 1, modes_);
        const double Theta_dot = rate_[0], alpha = h.dot(q), alpha_dot = h.dot(dq);
        const Eigen::Index nodes = rule_.x.size();
        v_.noalias() = phi_ * q;
        dv_.noalias() = phi_ * dq;
        shortened_.reshaped().noalias() = shortening_ * q;  // ∂u/∂q but for the hub
        u_.noalias() = 0.5 * (shortened_ * q);
        du_.noalias() = shortened_ * dq;
        u_.array() -= 0.5 * radius_ * alpha * alpha;
        du_.array() -= radius_ * alpha * alpha_dot;
        auto x = columns_.topRows(nodes);
        scratch_ = rule_.x + u_;
        scratch_.array() += radius_;
        x.col(0) = -root_weight_.cwiseProduct(v_);
        columns_.col(0).tail(nodes) = root_weight_.cwiseProduct(scratch_);
        for (int i = 0; i < modes_; ++i)
            x.col(1 + i) = root_weight_.array() * (shortened_.col(i).array() - radius_ * alpha * h[i]);
        // r̈ at ξ̈ = 0, in the frame: −Θ̇²r + 2Θ̇ k×(u̇, v̇) + (ü, 0), ü = −∫v̇′² − aα̇²      (S17)
        auto bias_x = bias_.head(nodes), bias_y = bias_.tail(nodes);
        bias_x = -Theta_dot * Theta_dot * scratch_ - 2 * Theta_dot * dv_;
        scratch_.noalias() = phi1_ * dq;
        scratch_ = scratch_.cwiseAbs2();
        bias_x.noalias() -= primitive_ * scratch_;
        bias_x.array() += gravity_ * std::sin(xi_[0]) - radius_ * alpha_dot * alpha_dot;
        bias_y = -Theta_dot * Theta_dot * v_ + 2 * Theta_dot * du_;
        bias_y.array() += gravity_ * std::cos(xi_[0]);
        bias_x.array() *= root_weight_.array();
        bias_y.array() *= root_weight_.array();
    }

    void node_kinematics() const override {
        BeamPoint p;
        for (Eigen::Index k = 0; k < rule_.x.size(); ++k) {
            line_.point(rule_.x[k], p);
            y_[k] = p.r.y;
            vx_[k] = p.v.x;
            vy_[k] = p.v.y;
        }
    }

    ModalModel line_;  // the shapes, and the centre line in the set state
    Eigen::MatrixXd phi_, phi1_;
    Eigen::MatrixXd shortening_, shortened_;  // −∫₀ˣφ_i′φ_j′: rows by i, then node; its product with q
    Eigen::VectorXd v_, dv_, u_, du_;
};

}  // namespace

// Products of four shapes oscillate with 4β_N.
int second_order_nodes(const Problem& problem) { return 3 * problem.beam.modes + 20; }

std::unique_ptr<Model> make_second_order_model(const Problem& problem) {
    return std::make_unique<SecondOrderModel>(problem);
}

}  // namespace beamcam::sim
