#include "sim/beam/quadrature_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/linear_algebra.hpp"
#include "sim/base/numerics.hpp"
#include "sim/base/ode.hpp"
#include "sim/beam/constants.hpp"
#include "sim/beam/modal_model.hpp"

namespace beamcam::sim {
namespace {

using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxSize, kMaxSize>;

// The projection of columns c = ∂r/∂ξ and of the acceleration at ξ̈ = 0. At each node both are multiplied by √(ρAw).
//   M = ρA Σ w cᵀc + I_h hᵀh,   f = −ρA Σ w cᵀ(r̈|ξ̈=0 + g) − Kq − C_d q̇           (S16)
class QuadratureModel : public Model {
  public:
    bool assemble(double* f) override {
        columns();
        inertia_.triangularView<Eigen::Lower>() = columns_.transpose() * columns_;
        Eigen::Map<Eigen::VectorXd> force(f, size_);
        force.noalias() = columns_.transpose() * bias_;
        force = -force;  // as a separate statement, because Eigen 5 copies a negated product
        for (int j = 0; j < size_; ++j)
            for (int i = j; i < size_; ++i) inertia_(i, j) += hub_inertia_ * hub_row_[i] * hub_row_[j];
        const Eigen::Map<const Eigen::VectorXd> q(xi_ + 1, modes_);
        Eigen::Map<Eigen::VectorXd>(f + 1, modes_).noalias() -= bending_ * q;
        add_damping(f);
        factor_.compute(inertia_);
        return factor_.info() == Eigen::Success && factor_.vectorD().minCoeff() > 0;
    }

    void solve(double* f) const override {
        Eigen::Map<Eigen::VectorXd> force(f, size_);
        factor_.solveInPlace(force);
    }

    double solve_held(double* f, double hub) const override {
        Eigen::Map<Eigen::VectorXd> force(f + 1, modes_);
        const Small inner = inertia_.bottomRightCorner(modes_, modes_);
        force -= hub * inertia_.col(0).tail(modes_);
        Eigen::LDLT<Small> inner_factor(inner);
        inner_factor.solveInPlace(force);
        const double torque = inertia_(0, 0) * hub + inertia_.col(0).tail(modes_).dot(force) - f[0];
        f[0] = hub;
        return torque;
    }

    void linearize(double* mass, double* stiffness, double* centrifugal) const override {
        // The centrifugal part is a central difference of fourth order of the bias force, which is quadratic in the
        // speed and odd in q near q = 0.
        const std::unique_ptr<Model> copy = clone();
        auto& model = static_cast<QuadratureModel&>(*copy);
        model.damped_ = false;
        model.gravity_ = 0;
        double xi[kMaxSize] = {}, rate[kMaxSize] = {}, f[kMaxSize], g[kMaxSize];
        model.set(xi, rate);
        if (!model.assemble(f)) throw InertiaLost();
        Eigen::Map<Eigen::MatrixXd> mm(mass, size_, size_), kk(stiffness, size_, size_), cc(centrifugal, size_, size_);
        mm = model.inertia_.selfadjointView<Eigen::Lower>();
        kk.setZero();
        kk.bottomRightCorner(modes_, modes_) = bending_;
        model.bending_.setZero();
        cc.setZero();
        rate[0] = 1;
        const double step = kDeflectionDifference * (angular_ ? 1.0 : length_);
        for (int j = 1; j < size_; ++j) {
            const auto odd = [&](double q, double* out) {  // odd part of the force, even if the inertia is not positive
                double back[kMaxSize];
                xi[j] = q;
                model.set(xi, rate);
                model.assemble(out);
                xi[j] = -q;
                model.set(xi, rate);
                model.assemble(back);
                xi[j] = 0;
                for (int i = 0; i < size_; ++i) out[i] = 0.5 * (out[i] - back[i]);
            };
            odd(step, f);
            odd(2 * step, g);
            for (int i = 1; i < size_; ++i) cc(i, j) = -(8 * f[i] - g[i]) / (6 * step);
        }
    }

    double frequency(int i) const override { return frequencies_[static_cast<std::size_t>(i)]; }

    Energies energies() const override {
        Energies e;
        node_kinematics();
        double height = 0;
        for (Eigen::Index k = 0; k < rule_.x.size(); ++k) {
            const double w = line_density_ * rule_.w[k];
            e.kinetic += 0.5 * w * (vx_[k] * vx_[k] + vy_[k] * vy_[k]);
            height += w * y_[k];
        }
        const double turn = hub_rate();
        e.kinetic += 0.5 * hub_inertia_ * turn * turn;
        e.gravity = gravity_ * height;
        const Eigen::Map<const Eigen::VectorXd> q(xi_ + 1, modes_);
        e.elastic = 0.5 * q.dot(bending_ * q);
        return e;
    }

  protected:
    QuadratureModel(const Problem& problem, int nodes) : Model(problem) {
        rule_ = gauss_legendre(nodes, length_);
        integral_ = SpectralIntegral(rule_, length_);
        primitive_ = integral_.matrix(rule_);
        root_weight_ = (line_density_ * rule_.w).cwiseSqrt();
        columns_ = Eigen::MatrixXd::Zero(2 * nodes, size_);
        bias_.resize(2 * nodes);
        for (Eigen::VectorXd* v : {&y_, &vx_, &vy_, &scratch_}) v->resize(nodes);
        inertia_.resize(size_, size_);
    }
    QuadratureModel(const QuadratureModel&) = default;

    void finish(const Problem& problem) {
        double f[kMaxSize];
        const double zero[kMaxSize] = {};
        set(zero, zero);
        if (!assemble(f)) throw InertiaLost();
        // Natural frequencies of the straight clamped beam. For polynomials the ratios K_ii/M_ii would be far from
        // them.
        const Eigen::MatrixXd inertia = inertia_.selfadjointView<Eigen::Lower>();
        const Eigenmodes modes = eigenmodes(bending_, inertia.bottomRightCorner(modes_, modes_));
        frequencies_.resize(static_cast<std::size_t>(modes_));
        for (int i = 0; i < modes_; ++i)
            frequencies_[static_cast<std::size_t>(i)] = std::sqrt(std::max(0.0, modes.omega_squared[i]));
        build_damping(problem);
    }

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
            const ShapesAt shapes(*this, rule_.x[k]);
            for (int i = 0; i < modes_; ++i) {
                eta_(k, i) = shapes.value[i];
                for (int j = 0; j < modes_; ++j)
                    bending_(i, j) += stiffness_ * rule_.w[k] * shapes.slope[i] * shapes.slope[j];
            }
        }
        for (Eigen::VectorXd* v : {&cos_, &sin_, &psi_dot_, &weights_}) v->resize(nodes);
        turned_.resize(nodes, 2 * (size_ + 1));
        integrated_.resize(nodes, 2 * (size_ + 1));
        weighted_primitive_ = root_weight_.asDiagonal() * primitive_;
        finish(problem);
    }
    std::unique_ptr<Model> clone() const override { return std::make_unique<ExactModel>(*this); }

    void point(double x, BeamPoint& p) const override {
        const ShapesAt shapes(*this, x);
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
        const ShapesAt shapes(*this, x);
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
        const ShapesAt shapes(*this, x);
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
    struct ShapesAt {
        ShapesAt(const ExactModel& of, double x) : slope(value + of.modes_) {
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
        turned_.col(0) = -sin_;
        turned_.col(half) = cos_;
        turned_.col(half - 1) = -scratch_.cwiseProduct(cos_);
        turned_.col(2 * half - 1) = -scratch_.cwiseProduct(sin_);
        for (int i = 0; i < modes_; ++i) {
            turned_.col(1 + i) = -sin_.cwiseProduct(eta_.col(i));
            turned_.col(half + 1 + i) = cos_.cwiseProduct(eta_.col(i));
        }
        integrated_.noalias() = weighted_primitive_ * turned_;
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
    mutable double weighed_ = -1;                               // x of weights_
    Eigen::MatrixXd weighted_primitive_, turned_, integrated_;  // columns and bias of x, then of y
    Eigen::VectorXd cos_, sin_, psi_dot_;
};

}  // namespace

// Products of four shapes oscillate with 4β_N; sine and cosine of the section angle are smoother.
int second_order_nodes(const Problem& problem) { return 3 * problem.beam.modes + 20; }
int exact_nodes(const Problem& problem) { return 2 * problem.beam.modes + 24; }

// P_j⁽ᵐ⁾ = P_{j−2}⁽ᵐ⁾ + (2j − 1) P_{j−1}⁽ᵐ⁻¹⁾, times (2/L)ᵐ.
void section_angle_shapes(double x, double length, int count, int order, double* values) {
    double before[kMaxModes + 1], here[kMaxModes + 1] = {}, scale = 1;
    legendre(2 * x / length - 1, count + 1, before);
    for (int j = 1; j <= count; ++j) values[j - 1] = before[j] - (j % 2 ? -1.0 : 1.0);
    for (int m = 1; m <= order; ++m) {
        scale *= 2 / length;
        for (int j = 1; j <= count; ++j) here[j] = (j > 1 ? here[j - 2] : 0) + (2 * j - 1) * before[j - 1];
        for (int j = 1; j <= count; ++j) values[m * count + j - 1] = scale * here[j];
        std::copy_n(here, count + 1, before);
        here[0] = 0;
    }
}

std::unique_ptr<Model> make_quadrature_model(const Problem& problem) {
    if (problem.beam.model == ModelKind::exact) return std::make_unique<ExactModel>(problem);
    return std::make_unique<SecondOrderModel>(problem);
}

}  // namespace beamcam::sim
