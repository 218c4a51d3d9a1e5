#include "sim/beam/modes.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/linear_algebra.hpp"
#include "sim/beam/model.hpp"

namespace beamcam::sim {
namespace {

constexpr int kShapePlaces = 101;  // points of a natural mode: a polyline of 20 waves looks smooth

// Small displacements are linear in the coordinates: y = (∂Y/∂ξ) ξ at rest, the state of the model.
std::vector<Vec2> shape_of(const Model& model, const Eigen::VectorXd& xi) {
    std::vector<Vec2> shape;
    for (int p = 0; p < kShapePlaces; ++p) {
        const double x = model.length() * p / (kShapePlaces - 1);
        double jx[kMaxSize], jy[kMaxSize], jchi[kMaxSize], y = 0;
        model.jacobian(x, jx, jy, jchi);
        for (Eigen::Index i = 0; i < xi.size(); ++i) y += jy[i] * xi[i];
        shape.push_back({x, y});
    }
    return shape;
}

}  // namespace

std::vector<Mode> natural_modes(const Problem& given, std::optional<double> speed) {
    Problem problem = given;
    problem.gravity = 0;
    problem.beam.damping_ratio.clear();
    problem.beam.kelvin_voigt.reset();
    // For a hub with prescribed motion the basis `auto` is the clamped one.
    const bool held = speed.has_value() || is_prescribed(problem.hub.drive);
    if (held && problem.beam.basis == Basis::automatic) problem.beam.basis = Basis::cantilever;
    const std::unique_ptr<Model> model = make_model(problem);
    const Eigen::Index size = model->size(), n = size - 1;
    const double spring = !held && problem.hub.spring ? problem.hub.spring->stiffness : 0;
    if (n == 0 && spring == 0) return {};
    Linearization linear = model->linearize();
    const Eigen::Map<const Eigen::VectorXd> hub(model->hub_row(), size);  // θ = hub·ξ
    linear.stiffness += spring * hub * hub.transpose();
    if (speed) linear.stiffness += *speed * *speed * linear.centrifugal;

    // Reduction (Θ, q) → q. With a free hub, Θ has no stiffness and follows from its row; with a clamped one,
    // θ = Θ + h·q = 0. Both have the form Θ = −c·q (S42). A spring gives Θ a stiffness, and the hub a mode of its own.
    Eigen::RowVectorXd follow(n);
    for (Eigen::Index i = 0; i < n; ++i)
        follow[i] = held ? -model->hub_row()[1 + i] : -linear.mass(0, 1 + i) / linear.mass(0, 0);
    Eigen::MatrixXd reduce = Eigen::MatrixXd::Identity(size, size);
    if (spring == 0) {
        reduce.resize(size, n);
        reduce.row(0) = follow;
        reduce.bottomRows(n).setIdentity();
    }
    const Eigen::MatrixXd m = in_basis(linear.mass, reduce);
    Eigen::MatrixXd k = in_basis(linear.stiffness, reduce);
    k = 0.5 * (k + k.transpose()).eval();
    const Eigenmodes natural = eigenmodes(k, m);

    const double zero[kMaxSize] = {};
    model->set(zero, zero);
    std::vector<Mode> modes(static_cast<std::size_t>(reduce.cols()));
    for (Eigen::Index j = 0; j < reduce.cols(); ++j) {
        Mode& mode = modes[static_cast<std::size_t>(j)];
        const double square = natural.omega_squared[j];
        mode.omega = square >= 0 ? std::sqrt(square) : std::numeric_limits<double>::quiet_NaN();
        const Eigen::VectorXd xi = reduce * natural.shapes.col(j);
        mode.shape = shape_of(*model, xi);
        const double sign = mode.shape.back().y < 0 ? -1 : 1;
        for (Vec2& at : mode.shape) at.y *= sign;
        for (const double q : xi.tail(n)) mode.q.push_back(sign * q + 0.0);  // no −0
    }
    return modes;
}

std::vector<std::size_t> unconverged_modes(const std::vector<Mode>& modes, const Problem& problem,
                                           std::optional<double> speed) {
    constexpr double kConverged = 0.005;  // convergence like 1/N at a hub's spring leaves as much again
    Problem finer = problem;
    finer.beam.modes = std::min(2 * problem.beam.modes + 4, kMaxModes);
    // Small vibrations of `exact` are those of `first-order`, whose shapes are the modes at rest.
    if (finer.beam.model == ModelKind::exact)
        finer.beam.model = ModelKind::first_order, finer.beam.basis = Basis::automatic;
    const std::vector<Mode> reference = natural_modes(finer, speed);
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < modes.size(); ++i)
        if (std::abs(modes[i].omega - reference[i].omega) > kConverged * reference[i].omega) all.push_back(i);
    return all;
}

}  // namespace beamcam::sim
