// The forcing where the modes are not the coordinates, from the forces of inertia. MODEL.md §12.
#include <algorithm>
#include <cmath>

#include "sim/integrate/nodal_step.hpp"

namespace beamcam::sim {

void NodalStep::place_coordinates(bool in_contact) {
    if (!inertia_) return;
    const ExponentialSegment& s = segment;
    const std::size_t rows = in_contact || !inertia_->in_modes() ? n + 1 : 1;
    kernels_.multiply(rows, n, form->mode_columns.data(), s.q.data(), position_.data());
    kernels_.multiply(rows, n, form->mode_columns.data(), s.v.data(), rate_.data());
    position_[0] += theta;
    rate_[0] += s.theta_dot;
    advance_angle(position_[0]);
}

// The residual of the equations of motion at the nodal accelerations, added to these, is the forcing.
double NodalStep::update_by_inertia(const StepTable& table, const ContactLoad* load) {
    ExponentialSegment& s = segment;
    const double h = table.h, per_mass = 1 / form->mass;
    evaluations += kNodes;
    for (std::size_t i = 0; i < n; ++i) {
        const Oscillator& o = form->oscillators[i];
        mode_acceleration_[i] = s.f[i] - 2 * o.gamma * s.v[i] - o.omega * o.omega * s.q[i];
    }
    const Lanes turn_acceleration = form->prescribed ? acceleration_ : (1 / form->J) * s.p_dot;
    const Lanes* resistance = forces_.data() + 1;  // of the modes
    if (inertia_->in_modes()) {
        inertia_->evaluate(
            {s.theta_dot, turn_acceleration, s.q.data(), s.v.data(), mode_acceleration_.data(), sin, cos},
            forces_.data());
    } else {
        Lanes* acceleration = coordinate_acceleration_.data();
        kernels_.multiply(n + 1, n, form->mode_columns.data(), mode_acceleration_.data(), acceleration);
        acceleration[0] += turn_acceleration;
        inertia_->evaluate(
            {rate_[0], acceleration[0], position_.data() + 1, rate_.data() + 1, acceleration + 1, sin, cos},
            forces_.data());
        kernels_.multiply(n, n + 1, form->mode_rows.data(), forces_.data(), bq_.data());
        resistance = bq_.data();
    }
    // The moment on the rigid turn that is out of balance, and the forcing that would balance the modes; the change of
    // the frame's acceleration by both.
    Lanes hub = torque - forces_[0];
    if (load) hub += load->torque();
    const double* row = form->mode_columns.data();
    Lanes turn = hub * (1 / form->J);
    for (std::size_t i = 0; i < n; ++i) {
        Lanes force = form->h[i] * torque - resistance[i];
        if (load) force += load->modal(i);
        bq_[i] = mode_acceleration_[i] + per_mass * force;
        turn += row[i] * (bq_[i] - s.f[i]);
    }
    const Lanes moment = form->prescribed ? Lanes{} : moment_of_bent_inertia(turn);
    double change2 = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Lanes f = bq_[i] - (per_mass * row[i]) * moment;
        const double d = largest(f - s.f[i]) * std::min(h, 1 / form->oscillators[i].omega);
        change2 += d * d;
        s.f[i] = f;
    }
    const double modal = std::sqrt(change2) / scale_modes;
    if (form->prescribed) return modal;
    s.p_dot += hub - moment;
    return std::max(modal, turn_hub(h, Lanes{} + form->J));
}

// The moment that the inertia g by which bending adds to that of the straight beam, D, takes from a change of the
// frame's acceleration: the inverse of D + g rrᵀ, r the hub's row, is D⁻¹ − D⁻¹r g/(1 + g rᵀD⁻¹r) rᵀD⁻¹.
Lanes NodalStep::moment_of_bent_inertia(const Lanes& turn) const {
    const double* row = form->mode_columns.data();
    double mobility = 1 / form->J;
    for (std::size_t i = 0; i < n; ++i) mobility += (1 / form->mass) * row[i] * row[i];
    const Lanes gain = inertia_->hub_inertia_gain();
    return turn * gain / (1 + mobility * gain);
}

}  // namespace beamcam::sim
