// The forcing where the modes are not the coordinates, from the forces of inertia. MODEL.md §12.
#include <algorithm>
#include <cmath>

#include "sim/integrate/nodal_step.hpp"

namespace beamcam::sim {

void NodalStep::place_coordinates() {
    if (!inertia_) return;
    const ExponentialSegment& s = segment;
    product(n + 1, n, form->mode_columns.data(), s.q.data(), position_.data());
    product(n + 1, n, form->mode_columns.data(), s.v.data(), rate_.data());
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
    Lanes* acceleration = coordinate_acceleration_.data();
    product(n + 1, n, form->mode_columns.data(), mode_acceleration_.data(), acceleration);
    acceleration[0] += turn_acceleration;
    inertia_->evaluate({rate_[0], acceleration[0], position_.data() + 1, rate_.data() + 1, acceleration + 1, sin, cos},
                       forces_.data());
    product(n, n + 1, form->mode_rows.data(), forces_.data(), resistance_.data());
    double change2 = 0;
    for (std::size_t i = 0; i < n; ++i) {
        Lanes force = form->h[i] * torque - resistance_[i];
        if (load) force += load->modal(i);
        const Lanes f = mode_acceleration_[i] + per_mass * force;
        const double d = largest(f - s.f[i]) * std::min(h, 1 / form->oscillators[i].omega);
        change2 += d * d;
        s.f[i] = f;
    }
    const double modal = std::sqrt(change2) / scale_modes;
    if (form->prescribed) return modal;
    // The moment on the rigid turn that is out of balance.
    s.p_dot += torque - forces_[0];
    if (load) s.p_dot += load->torque();
    return std::max(modal, turn_hub(h, Lanes{} + form->J));
}

}  // namespace beamcam::sim
