#include "sim/integrate/inertia_forces.hpp"

#include "sim/base/numerics.hpp"
#include "sim/beam/exact_model.hpp"

namespace beamcam::sim {

InertiaForces::LaneMatrix::LaneMatrix(const Eigen::MatrixXd& m)
    : rows_(static_cast<std::size_t>(m.rows())), columns_(static_cast<std::size_t>(m.cols())) {
    for (Eigen::Index i = 0; i < m.rows(); ++i)
        for (Eigen::Index j = 0; j < m.cols(); ++j) numbers_.push_back(m(i, j));
}

InertiaForces::InertiaForces(const Problem& problem)
    : radius_(problem.hub.radius), hub_inertia_(problem.hub.inertia), gravity_(problem.gravity) {
    const Beam& beam = problem.beam;
    const Quadrature rule = gauss_legendre(exact_nodes(problem), beam.length);
    const Eigen::Index nodes = rule.x.size(), n = beam.modes;
    const Eigen::MatrixXd primitive = SpectralIntegral(rule, beam.length).matrix(rule);
    const Eigen::VectorXd weights = beam.line_density() * rule.w;
    mass_ = weights.sum();
    mass_beyond_ = primitive.transpose() * weights;
    double_integral_ = LaneMatrix(primitive.transpose() * weights.asDiagonal() * primitive);
    Eigen::MatrixXd eta(nodes, n);
    Eigen::VectorXd row(n);
    for (Eigen::Index k = 0; k < nodes; ++k) {
        section_angle_shapes(rule.x[k], beam.length, beam.modes, 0, row.data());
        eta.row(k) = row.transpose();
    }
    shapes_ = LaneMatrix(eta);
    shapes_transposed_ = LaneMatrix(eta.transpose());
    for (auto* v : {&sin_, &cos_, &rate_, &bend_, &x_, &y_}) v->resize(static_cast<std::size_t>(nodes));
}

void InertiaForces::evaluate(const NodalMotion& m, Lanes* out) {
    const Lanes &theta_dot = m.turn_rate, &theta_ddot = m.turn_acceleration;
    shapes_.times(m.position, bend_.data());
    for (std::size_t k = 0; k < sin_.size(); ++k) sine_and_cosine(bend_[k], sin_[k], cos_[k]);
    shapes_.times(m.rate, rate_.data());
    shapes_.times(m.acceleration, bend_.data());
    for (std::size_t k = 0; k < sin_.size(); ++k) {
        const Lanes rate = rate_[k] + theta_dot, square = rate * rate, bend = bend_[k] + theta_ddot;
        rate_[k] = -bend * sin_[k] - square * cos_[k];
        bend_[k] = bend * cos_[k] - square * sin_[k];
    }
    double_integral_.times(rate_.data(), x_.data());
    double_integral_.times(bend_.data(), y_.data());
    const Lanes along = gravity_ * m.sin - radius_ * theta_dot * theta_dot,
                across = gravity_ * m.cos + radius_ * theta_ddot;
    Lanes moment{}, whole = mass_ * across;
    for (std::size_t k = 0; k < sin_.size(); ++k) {
        const double beyond = mass_beyond_[k];
        whole += beyond * bend_[k];
        x_[k] = cos_[k] * (y_[k] + beyond * across) - sin_[k] * (x_[k] + beyond * along);
        moment += x_[k];
    }
    shapes_transposed_.times(x_.data(), out + 1);
    out[0] = moment + radius_ * whole + hub_inertia_ * theta_ddot;
}

}  // namespace beamcam::sim
