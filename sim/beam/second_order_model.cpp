#include "sim/beam/second_order_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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
        bending_ = Eigen::MatrixXd::Zero(modes_, modes_);
        Eigen::VectorXd y(modes_), y1(modes_), y2(modes_);
        for (Eigen::Index k = 0; k < nodes; ++k) {
            line_.shapes().evaluate(rule_.x[k], y.data(), y1.data(), y2.data());
            phi_.row(k) = y.transpose();
            phi1_.row(k) = y1.transpose();
            bending_.noalias() += stiffness_ * rule_.w[k] * y2 * y2.transpose();
        }
        std::copy_n(line_.hub_row(), size_, hub_row_);
        for (Eigen::VectorXd* v : {&v_, &v1_, &dv_, &dv1_, &u_, &du_}) v->resize(nodes);
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

    void state_changed() override {
        line_.set(xi_, rate_);
        sin_ = std::sin(xi_[0]);
        cos_ = std::cos(xi_[0]);
        const Eigen::Map<const Eigen::VectorXd> q(xi_ + 1, modes_), dq(rate_ + 1, modes_);
        v_.noalias() = phi_ * q;
        v1_.noalias() = phi1_ * q;
        dv_.noalias() = phi_ * dq;
        dv1_.noalias() = phi1_ * dq;
        shortening_known_ = false;
        alpha_ = alpha_dot_ = 0;
        for (int i = 1; i < size_; ++i) {
            alpha_ += hub_row_[i] * xi_[i];
            alpha_dot_ += hub_row_[i] * rate_[i];
        }
    }

    // ∂u/∂q, u and u̇ at the nodes.
    void shorten() const {
        if (std::exchange(shortening_known_, true)) return;
        const Eigen::Map<const Eigen::VectorXd> q(xi_ + 1, modes_), dq(rate_ + 1, modes_);
        shortened_.reshaped().noalias() = shortening_ * q;
        u_.noalias() = 0.5 * (shortened_ * q);
        du_.noalias() = shortened_ * dq;
        u_.array() -= 0.5 * radius_ * alpha_ * alpha_;
        du_.array() -= radius_ * alpha_ * alpha_dot_;
    }

    void columns() override {
        shorten();
        const double Theta_dot = rate_[0];
        const Eigen::Index nodes = rule_.x.size();
        auto x = columns_.topRows(nodes);
        scratch_ = rule_.x + u_;
        scratch_.array() += radius_;
        x.col(0) = -root_weight_.cwiseProduct(v_);
        columns_.col(0).tail(nodes) = root_weight_.cwiseProduct(scratch_);
        for (int i = 0; i < modes_; ++i)
            x.col(1 + i) = root_weight_.array() * (shortened_.col(i).array() - radius_ * alpha_ * hub_row_[1 + i]);
        // r̈ at ξ̈ = 0, in the frame: −Θ̇²r + 2Θ̇ k×(u̇, v̇) + (ü, 0), ü = −∫v̇′² − aα̇²      (S17)
        auto bias_x = bias_.head(nodes), bias_y = bias_.tail(nodes);
        bias_x = -Theta_dot * Theta_dot * scratch_ - 2 * Theta_dot * dv_;
        scratch_ = dv1_.cwiseAbs2();
        bias_x.noalias() -= primitive_ * scratch_;
        bias_x.array() += gravity_ * sin_ - radius_ * alpha_dot_ * alpha_dot_;
        bias_y = -Theta_dot * Theta_dot * v_ + 2 * Theta_dot * du_;
        bias_y.array() += gravity_ * cos_;
        bias_x.array() *= root_weight_.array();
        bias_y.array() *= root_weight_.array();
    }

    void node_kinematics() const override {
        shorten();
        const double Theta_dot = rate_[0];
        for (Eigen::Index k = 0; k < rule_.x.size(); ++k) {
            const double rx = radius_ + rule_.x[k] + u_[k];
            y_[k] = rx * sin_ + v_[k] * cos_;
            vx_[k] = du_[k] - v_[k] * Theta_dot;
            vy_[k] = dv_[k] + rx * Theta_dot;
        }
    }

    ModalModel line_;  // the shapes, and the centre line in the set state
    Eigen::MatrixXd phi_, phi1_;
    Eigen::MatrixXd shortening_;  // −∫₀ˣφ_i′φ_j′: rows by i, then node
    mutable Eigen::MatrixXd shortened_;
    mutable bool shortening_known_ = false;  // of the set state
    Eigen::VectorXd v_, v1_, dv_, dv1_;
    mutable Eigen::VectorXd u_, du_;
    double sin_ = 0, cos_ = 1, alpha_ = 0, alpha_dot_ = 0;
};

}  // namespace

// Products of four shapes oscillate with 4β_N.
int second_order_nodes(const Problem& problem) { return 3 * problem.beam.modes + 20; }

std::unique_ptr<Model> make_second_order_model(const Problem& problem) {
    return std::make_unique<SecondOrderModel>(problem);
}

}  // namespace beamcam::sim
