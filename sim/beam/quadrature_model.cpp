#include "sim/beam/quadrature_model.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/linear_algebra.hpp"
#include "sim/base/ode.hpp"

namespace beamcam::sim {

// The step of the finite differences of centrifugal forces [length, or rad]; their error is of fourth order, 1e-12.
constexpr double kDeflectionDifference = 1e-3;

QuadratureModel::QuadratureModel(const Problem& problem, int nodes) : Model(problem) {
    rule_ = gauss_legendre(nodes, length_);
    integral_ = SpectralIntegral(rule_, length_);
    primitive_ = integral_.matrix(rule_);
    root_weight_ = (line_density_ * rule_.w).cwiseSqrt();
    columns_ = Eigen::MatrixXd::Zero(2 * nodes, size_);
    bias_.resize(2 * nodes);
    for (Eigen::VectorXd* v : {&y_, &vx_, &vy_, &scratch_}) v->resize(nodes);
    inertia_.resize(size_, size_);
}

void QuadratureModel::finish(const Problem& problem) {
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

bool QuadratureModel::assemble(double* f) {
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

void QuadratureModel::solve(double* f) const {
    Eigen::Map<Eigen::VectorXd> force(f, size_);
    factor_.solveInPlace(force);
}

double QuadratureModel::solve_held(double* f, double hub) const {
    Eigen::Map<Eigen::VectorXd> force(f + 1, modes_);
    const Small inner = inertia_.bottomRightCorner(modes_, modes_);
    force -= hub * inertia_.col(0).tail(modes_);
    Eigen::LDLT<Small> inner_factor(inner);
    inner_factor.solveInPlace(force);
    const double torque = inertia_(0, 0) * hub + inertia_.col(0).tail(modes_).dot(force) - f[0];
    f[0] = hub;
    return torque;
}

Linearization QuadratureModel::linearize() const {
    // The centrifugal part is a central difference of fourth order of the bias force, which is quadratic in the
    // speed and odd in q near q = 0.
    const std::unique_ptr<Model> copy = clone();
    auto& model = static_cast<QuadratureModel&>(*copy);
    model.damping_ = nullptr;
    model.gravity_ = 0;
    double xi[kMaxSize] = {}, rate[kMaxSize] = {}, f[kMaxSize], g[kMaxSize];
    model.set(xi, rate);
    if (!model.assemble(f)) throw InertiaLost();
    Linearization linear(size_);
    linear.mass = model.inertia_.selfadjointView<Eigen::Lower>();
    linear.stiffness.bottomRightCorner(modes_, modes_) = bending_;
    model.bending_.setZero();
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
        for (int i = 1; i < size_; ++i) linear.centrifugal(i, j) = -(8 * f[i] - g[i]) / (6 * step);
    }
    return linear;
}

Energies QuadratureModel::energies() const {
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

}  // namespace beamcam::sim
