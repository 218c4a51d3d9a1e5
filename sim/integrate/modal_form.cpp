#include "sim/integrate/modal_form.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/assert.hpp"
#include "sim/base/linear_algebra.hpp"
#include "sim/beam/modal_model.hpp"
#include "sim/beam/natural_modes.hpp"

namespace beamcam::sim {
namespace {

constexpr int kPlacesPerWave = 32;       // where natural modes are evaluated for their largest values
constexpr double kBetweenPlaces = 1.05;  // a sine between places a 32nd of a half wave apart: 1.0012

void copy_rows(const Eigen::MatrixXd& m, double factor, std::vector<double>& out) {
    const Eigen::Index n = m.rows();
    out.resize(static_cast<std::size_t>(n * n));
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j) out[static_cast<std::size_t>(i * n + j)] = factor * m(i, j);
}

// Otherwise the oscillators are the natural modes.
bool modes_are_coordinates(System& system) {
    const auto* model = dynamic_cast<const ModalModel*>(&system.model());
    return model && model->kind() != ModelKind::paper && (!model->coupled() || system.drive().prescribed());
}

}  // namespace

std::shared_ptr<ModalForm> ModalForm::begin(const System& system, const Model& model) {
    auto form = std::make_shared<ModalForm>();
    form->n = model.size() - 1;
    form->prescribed = system.drive().prescribed();
    form->damped = model.damping() != nullptr;
    form->mass = model.mass();
    form->gravity = system.problem().gravity;
    form->radius = system.problem().hub.radius;
    form->length = model.length();
    return form;
}

bool ModalForm::exists(System& system) {
    return system.problem().beam.model == ModelKind::exact || modes_are_coordinates(system);
}

std::shared_ptr<const ModalForm> ModalForm::of(System& system) {
    BEAMCAM_ASSERT(exists(system));
    return modes_are_coordinates(system) ? by_arrays_of(system) : of_natural_modes(system);
}

std::shared_ptr<const ModalForm> ModalForm::by_arrays_of(System& system) {
    const auto* model = static_cast<const ModalModel*>(&system.model());
    BEAMCAM_ASSERT(!model->damping() || model->damping()->isDiagonal(0));
    auto form = begin(system, *model);
    const ModalMatrices& m = model->matrices();
    const int n = form->n;
    form->shortening = model->foreshortening();
    form->J = m.J;
    form->S = m.S;
    for (int i = 0; i < n; ++i) {
        Oscillator o{model->frequency(i), 0};
        if (model->damping()) o.gamma = 0.5 * (*model->damping())(i, i) / form->mass;
        form->oscillators.push_back(o);
        form->weight.push_back(m.W[i] / form->mass);
        form->U.push_back(model->coupled() ? m.U[i] : 0);
        form->h.push_back(m.slope[i]);
        form->beta.push_back(model->shapes().beta(i));
        form->shape.push_back(model->shapes().bound(i));
    }
    if (n == 0) return form;
    if (form->shortening) {
        std::vector<double> h(static_cast<std::size_t>(n * n));
        model->shortening_matrix(form->length, h.data());
        for (int i = 0; i < n; ++i)
            form->slope_norm.push_back(std::sqrt(h[static_cast<std::size_t>(i) * static_cast<std::size_t>(n + 1)]));
    }
    copy_rows(model->inertia_matrix(), 1, form->inertia);
    form->inertia_root = bounding_vector(model->inertia_matrix(), m.M.diagonal() + m.D.diagonal().cwiseAbs());
    if (model->kind() == ModelKind::first_order) copy_rows(m.G, 1 / form->mass, form->fall);
    return form;
}

void ModalForm::transform(const Eigen::MatrixXd& by, double* state) const {
    if (by.size() == 0) return;
    const Eigen::Index size = n + 1;
    double result[kMaxSize];
    Eigen::Map<Eigen::VectorXd> out(result, size);
    for (double* part : {state, state + size}) {
        out.noalias() = by * Eigen::Map<const Eigen::VectorXd>(part, size);
        std::copy_n(result, size, part);
    }
}

// Without vibration Θ = z₀; a mode rotates the frame against the mean rigid rotation, and its modal mass is that of the
// beam.
std::shared_ptr<const ModalForm> ModalForm::of_natural_modes(System& system) {
    Model& model = system.model();
    const Eigen::Index n = model.size() - 1;
    const NaturalModes modes(model, system.problem());
    auto form = begin(system, model);
    form->natural = modes.shapes;
    form->to_natural = modes.inverse;
    form->mode_rows.assign(form->natural.data() + (n + 1), form->natural.data() + (n + 1) * (n + 1));
    const Eigen::MatrixXd rows = form->natural.rightCols(n).transpose();
    form->mode_columns.assign(rows.data(), rows.data() + rows.size());
    form->J = modes.J;
    form->S = modes.S;
    form->shortening = true;
    for (Eigen::Index i = 0; i < n; ++i) {
        BEAMCAM_ASSERT(modes.omega_squared[i] > 0);
        form->oscillators.push_back({std::sqrt(modes.omega_squared[i]), 0.5 * modes.damping[i]});
    }
    form->bound_shapes(model, system.problem().beam.bending_stiffness());
    form->weight.assign(modes.weight.begin(), modes.weight.end());
    form->U.assign(modes.U.begin(), modes.U.end());
    form->inertia_root.assign(form->U.size(), 0);
    return form;
}

// From the largest displacement, rotation of the tangent and curvature of the straight beam at many places; a margin
// covers the values between them.
void ModalForm::bound_shapes(Model& model, double bending_stiffness) {
    const Eigen::Index count = natural.rows(), places = kPlacesPerWave * count;
    const double none[kMaxSize] = {};
    Eigen::VectorXd x(count), y(count), rotation(count);
    Eigen::ArrayXd displacement = Eigen::ArrayXd::Zero(count), slope = displacement, curvature = displacement;
    const auto place = [&](Eigen::Index k) { return length * static_cast<double>(k) / static_cast<double>(places); };
    model.set(none, none);
    for (Eigen::Index k = 0; k <= places; ++k) {
        model.jacobian(place(k), x.data(), y.data(), rotation.data());
        displacement = displacement.max((natural.transpose() * y).array().abs());
        slope = slope.max((natural.transpose() * rotation).array().abs());
    }
    for (Eigen::Index i = 1; i < count; ++i) {
        model.set(natural.col(i).data(), none);
        for (Eigen::Index k = 0; k <= places; ++k)
            curvature[i] = std::max(curvature[i], std::fabs(model.bending_moment(place(k)) / bending_stiffness));
    }
    const Eigen::VectorXd hub = natural.transpose() * Eigen::Map<const Eigen::VectorXd>(model.hub_row(), count);
    for (Eigen::Index i = 1; i < count; ++i) {
        h.push_back(hub[i]);
        shape.push_back(kBetweenPlaces * (displacement[i] + std::fabs(radius * hub[i])));
        beta.push_back(std::max(kBetweenPlaces * slope[i] / shape.back(),
                                std::sqrt(kBetweenPlaces * curvature[i] / shape.back())));
        slope_norm.push_back(std::sqrt(length) * shape.back() * beta.back());
    }
}

}  // namespace beamcam::sim
