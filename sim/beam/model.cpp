#include "sim/beam/model.hpp"

#include <algorithm>

#include "sim/base/linear_algebra.hpp"
#include "sim/base/numerics.hpp"
#include "sim/beam/exact_model.hpp"
#include "sim/beam/modal_model.hpp"
#include "sim/beam/second_order_model.hpp"

namespace beamcam::sim {

Model::Model(const Problem& problem)
    : length_(problem.beam.length),
      mass_(problem.beam.line_density() * problem.beam.length),
      radius_(problem.hub.radius),
      hub_inertia_(problem.hub.inertia),
      gravity_(problem.gravity),
      line_density_(problem.beam.line_density()),
      stiffness_(problem.beam.bending_stiffness()) {
    modes_ = problem.beam.model == ModelKind::rigid ? 0 : problem.beam.modes;
    size_ = 1 + modes_;
    hub_row_[0] = 1;
}

void Model::set(const double* xi, const double* rate) {
    std::copy_n(xi, size_, xi_);
    std::copy_n(rate, size_, rate_);
    state_changed();
}

double Model::hub_angle() const {
    double theta = 0;
    for (int i = 0; i < size_; ++i) theta += hub_row_[i] * xi_[i];
    return theta;
}

double Model::hub_rate() const {
    double rate = 0;
    for (int i = 0; i < size_; ++i) rate += hub_row_[i] * rate_[i];
    return rate;
}

void Model::add_damping(double* f) const {
    if (!damping_) return;
    for (int j = 0; j < modes_; ++j)
        for (int i = 0; i < modes_; ++i) f[1 + i] -= (*damping_)(i, j) * rate_[1 + j];
}

double Model::damping_power() const {
    if (!damping_) return 0;
    double force[kMaxSize] = {};
    add_damping(force);
    double power = 0;
    for (int i = 1; i < size_; ++i) power -= force[i] * rate_[i];
    return power;
}

void Model::build_damping(const Problem& problem) {
    const Beam& beam = problem.beam;
    const bool by_ratio =
        std::any_of(beam.damping_ratio.begin(), beam.damping_ratio.end(), [](double z) { return z != 0; });
    const bool by_time = beam.kelvin_voigt && *beam.kelvin_voigt > 0;
    if (modes_ == 0 || (!by_ratio && !by_time)) return;
    const Linearization linear = linearize();
    const Eigen::MatrixXd& mass = linear.mass;
    const Eigen::Index n = modes_;
    Eigen::MatrixXd damping(n, n);
    if (by_time) {
        damping = *beam.kelvin_voigt * linear.stiffness.bottomRightCorner(n, n);  // (S21)
    } else {
        // Modes with a free hub (Θ has no stiffness and is condensed out) or with a prescribed one (S20).
        Eigen::MatrixXd inertia = mass.bottomRightCorner(n, n);
        if (!is_prescribed(problem.hub.drive))
            inertia -= mass.bottomLeftCorner(n, 1) * mass.topRightCorner(1, n) / mass(0, 0);
        const Eigenmodes modes = eigenmodes(linear.stiffness.bottomRightCorner(n, n), inertia);
        Eigen::VectorXd twice(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            const std::size_t k = beam.damping_ratio.size() == 1 ? 0 : static_cast<std::size_t>(i);
            const double ratio = k < beam.damping_ratio.size() ? beam.damping_ratio[k] : 0;
            twice[i] = 2 * ratio * std::sqrt(std::max(0.0, modes.omega_squared[i]));
        }
        const Eigen::MatrixXd weighted = inertia * modes.shapes;
        damping = weighted_square(weighted, twice);
    }
    damping = 0.5 * (damping + damping.transpose()).eval();
    const Eigen::MatrixXd diagonal = damping.diagonal().asDiagonal();
    const double off = (damping - diagonal).cwiseAbs().maxCoeff();
    const bool uncoupled = off <= kNegligible * diagonal.cwiseAbs().maxCoeff();
    damping_ = std::make_shared<Eigen::MatrixXd>(uncoupled ? diagonal : damping);
}

std::unique_ptr<Model> make_model(const Problem& problem) {
    switch (problem.beam.model) {
        case ModelKind::rigid:
        case ModelKind::zeroth_order:
        case ModelKind::first_order:
        case ModelKind::paper:
            return std::make_unique<ModalModel>(problem);
        case ModelKind::second_order:
            return make_second_order_model(problem);
        case ModelKind::exact:
            return make_exact_model(problem);
    }
    return nullptr;
}

}  // namespace beamcam::sim
