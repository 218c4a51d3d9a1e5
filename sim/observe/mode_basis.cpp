#include "sim/observe/mode_basis.hpp"

#include <algorithm>
#include <cmath>

#include "sim/beam/modal_model.hpp"
#include "sim/beam/natural_modes.hpp"
#include "sim/integrate/modal_form.hpp"

namespace beamcam::sim {

ModeBasis::ModeBasis(System& system) {
    const Model& model = system.model();
    length = model.length();
    reach = std::fabs(system.problem().hub.radius) + length;
    mass = model.mass();
    hub.assign(model.hub_row(), model.hub_row() + model.size());
    bends_far = !dynamic_cast<const ModalModel*>(&model);
    modes_are_coordinates(system) ? of_coordinates(system) : of_natural_modes(system);
    pack_modes();
}

void ModeBasis::pack_modes() {
    groups.resize((size() + kNodes - 1) / kNodes);
    for (std::size_t i = 0; i < size(); ++i) {
        const Mode& mode = modes[i];
        Group& group = groups[i / kNodes];
        const int lane = static_cast<int>(i % kNodes);
        group.h[lane] = mode.h;
        group.turn[lane] = mode.turn;
        group.tip[lane] = mode.tip;
        group.U[lane] = std::fabs(mode.U);
        group.W[lane] = mode.W;
        group.stiffness[lane] = mode.stiffness;
        group.inertia[lane] = mode.inertia;
        group.weight[lane] = mode.weight;
        group.shape[lane] = mode.shape;
        group.slope[lane] = mode.slope;
        group.wave[lane] = mode.wave;
        group.omega[lane] = mode.omega;
        group.damping[lane] = mode.damping;
    }
}

void ModeBasis::of_coordinates(System& system) {
    const auto& model = static_cast<const ModalModel&>(system.model());
    const ModalMatrices& m = model.matrices();
    J = m.J;
    S = std::fabs(m.S);
    const int n = model.size() - 1;
    const double* damping = model.diagonal_damping();
    if (n == 0) return;
    double at_tip[kMaxModes], root[kMaxModes];
    model.shapes().evaluate(length, at_tip, nullptr, nullptr);
    model.shapes().evaluate(0, root, nullptr, nullptr);
    const double behind = mass * std::max(0.0, -system.problem().hub.radius);
    const std::vector<double> inertia =
                                  bounding_vector(model.inertia_matrix(), m.M.diagonal() + m.D.diagonal().cwiseAbs()),
                              weight = bounding_vector(m.G, m.G.diagonal() + 2 * behind * m.slope.cwiseAbs2());
    for (int i = 0; i < n; ++i) {
        const auto mode = static_cast<std::size_t>(i);
        const double shape = system.gap_bound().shape_bound(mode), wave = system.gap_bound().wave_number(mode);
        tip.push_back(at_tip[i] - root[i] - length * m.slope[i]);
        modes.push_back({std::fabs(m.slope[i]), m.slope[i], tip.back(), m.U[i], std::fabs(m.W[i]), m.K[i],
                         inertia[mode], weight[mode], shape, shape * wave, wave, model.frequency(i),
                         damping ? damping[i] / mass : 0});
    }
}

// The quadratic terms of foreshortening are at most m(|a| + ½L)s² in inertia and ms² in weight, s² = ∫φ′²; those of the
// root, which the hub turns, the share |a|/L of that.
void ModeBasis::of_natural_modes(System& system) {
    const NaturalModes& m = system.natural_modes();
    const std::unique_ptr<Model> model = system.model().clone();
    const Eigen::Index count = model->size(), n = count - 1;
    const double none[kMaxSize] = {};
    Eigen::VectorXd x(count), root(count), end(count), turned(count);
    model->set(none, none);
    model->jacobian(0, x.data(), root.data(), turned.data());
    model->jacobian(length, x.data(), end.data(), turned.data());
    const Eigen::VectorXd row = end - root - length * Eigen::Map<const Eigen::VectorXd>(hub.data(), count);
    tip.assign(row.begin() + 1, row.end());
    const Eigen::VectorXd by_mode = m.shapes.bottomRows(n).transpose() * row.tail(n);
    const Eigen::MatrixXd rows = m.shapes.transpose(), inverse_rows = m.inverse.transpose();
    natural.assign(rows.data(), rows.data() + rows.size());
    to_natural.assign(inverse_rows.data(), inverse_rows.data() + inverse_rows.size());
    J = m.J;
    S = std::fabs(m.S);
    const double root_mass = std::sqrt(mass), with_root = std::sqrt(reach / length),
                 arm = std::sqrt(reach - 0.5 * length);
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double square = std::max(0.0, m.omega_squared[i]), steep = m.slope_norm[k] * with_root;
        modes.push_back({std::fabs(m.h[k]), m.h[k], by_mode[i + 1], m.U[i], mass * std::fabs(m.weight[i]),
                         mass * square, root_mass * (1 + arm * steep), root_mass * steep, m.shape[k],
                         m.shape[k] * m.beta[k], m.beta[k], std::sqrt(square), m.damping[i]});
    }
}

void ModeBasis::to_modes(double* x) const {
    if (are_coordinates()) return;
    double result[kMaxSize];
    const std::size_t count = size() + 1;
    for (std::size_t i = 0; i < count; ++i) {
        result[i] = 0;
        for (std::size_t j = 0; j < count; ++j) result[i] += to_natural[i * count + j] * x[j];
    }
    std::copy_n(result, count, x);
}

}  // namespace beamcam::sim
