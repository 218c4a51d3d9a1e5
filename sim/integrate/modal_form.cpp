#include "sim/integrate/modal_form.hpp"

#include <algorithm>
#include <cmath>

#include "sim/beam/modal_model.hpp"

namespace beamcam::sim {
namespace {

void copy_rows(const Eigen::MatrixXd& m, double factor, std::vector<double>& out) {
    const Eigen::Index n = m.rows();
    out.resize(static_cast<std::size_t>(n * n));
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j) out[static_cast<std::size_t>(i * n + j)] = factor * m(i, j);
}

// A vector c with |B_ij| <= c_i c_j, in proportion to the roots of `squares` > 0.
std::vector<double> bounding_vector(const Eigen::MatrixXd& b, const Eigen::VectorXd& squares) {
    const Eigen::VectorXd c = squares.cwiseSqrt();
    const double share = b.cwiseAbs().cwiseQuotient(c * c.transpose()).maxCoeff();
    const Eigen::VectorXd scaled = std::sqrt(share) * c;
    return {scaled.begin(), scaled.end()};
}

}  // namespace

std::shared_ptr<const ModalForm> ModalForm::of(System& system) {
    const auto* model = dynamic_cast<const ModalModel*>(&system.model());
    const bool prescribed = system.drive().prescribed();
    if (!model || (model->coupled() && !prescribed)) return nullptr;
    if (model->damped() && !model->diagonal_damping()) return nullptr;

    auto form = std::make_shared<ModalForm>();
    const ModalMatrices& m = model->matrices();
    const Problem& problem = system.problem();
    const int n = model->size() - 1;
    form->n = n;
    form->prescribed = prescribed;
    form->paper = model->kind() == ModelKind::paper;
    form->shortening = model->foreshortening();
    form->damped = model->damped();
    form->J = m.J;
    form->S = m.S;
    form->mass = model->mass();
    form->gravity = problem.gravity;
    form->radius = problem.hub.radius;
    form->length = model->length();
    for (int i = 0; i < n; ++i) {
        Oscillator o{model->frequency(i), 0};
        if (const double* damping = model->diagonal_damping()) o.gamma = 0.5 * damping[i] / form->mass;
        form->oscillators.push_back(o);
        form->weight.push_back(m.W[i] / form->mass);
        form->U.push_back(model->coupled() ? m.U[i] : 0);
        form->h.push_back(m.slope[i]);
        form->beta.push_back(model->shapes().beta(i));
        form->shape.push_back(model->shapes().bound(i));
    }
    form->groups = side_by_side(form->oscillators);
    if (n == 0) return form;
    if (form->shortening) {
        std::vector<double> h(static_cast<std::size_t>(n * n));
        model->shortening_matrix(form->length, h.data());
        for (int i = 0; i < n; ++i)
            form->slope_norm.push_back(std::sqrt(h[static_cast<std::size_t>(i) * static_cast<std::size_t>(n + 1)]));
    }
    copy_rows(model->inertia_matrix(), 1, form->inertia);
    form->inertia_root = bounding_vector(model->inertia_matrix(), m.M.diagonal() + m.D.diagonal().cwiseAbs());
    if (form->paper) {
        copy_rows(m.M + form->radius * m.P1 + 0.5 * m.P2, 1 / form->mass, form->spinning);
        copy_rows(m.P0, 1 / form->mass, form->second);
    } else {
        copy_rows(model->inertia_matrix(), 1 / form->mass, form->spinning);
        if (model->kind() == ModelKind::first_order) copy_rows(m.G, 1 / form->mass, form->second);
    }
    return form;
}

}  // namespace beamcam::sim
