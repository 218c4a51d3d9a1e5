// The energy balance of an accepted step: powers at the nodes.
#include <algorithm>

#include "sim/integrate/nodal_step.hpp"

namespace beamcam::sim {

// The ledger of the step that ends at s.end, in modes.
void NodalStep::finish_ledger(const ContactLoad* load) {
    ExponentialSegment& s = segment;
    s.ledger_changes = load || form->damped || form->prescribed || system.drive().has_torque() || system.spring();
    if (!s.ledger_changes) {
        std::copy_n(s.ledger0, kLedgerSize, s.end.begin() + system.ledger_at);
        return;
    }
    for (Lanes& rate : s.rate) rate = Lanes{};
    if (form->damped)
        for (std::size_t i = 0; i < n; ++i)
            if (form->oscillators[i].gamma > 0) s.rate[kLossStructural] += form->mass * s.f[i] * s.resolved_rate(i);
    if (const auto& spring = system.spring()) s.rate[kLossHub] = spring->damping * hub_rate() * hub_rate();
    s.boundary0 = s.drive_boundary(s.t0, start_.data());
    drive_power(load);
    if (load) {
        const ContactKinematics<Lanes>& contact = load->contact;
        s.rate[kNormalWork] = -load->force * contact.gap_rate;
        s.rate[kFrictionWork] = -load->friction * contact.slip;
        s.rate[kWorkCam] = load->force * contact.cam_n + load->friction * contact.cam_t;
        s.rate[kImpulseN] = load->force;
        s.rate[kImpulseT] = load->friction;
    }
    s.prepare_vibration_work();
    s.put_ledger(s.t1, (s.t1 - s.t0) / s.h, s.end.data());
}

// Power of the drive at the nodes, without the part that `drive_boundary` has in closed form       (S55)
void NodalStep::drive_power(const ContactLoad* load) {
    ExponentialSegment& s = segment;
    const Collocation& gauss = Collocation::get();
    if (system.drive().has_torque()) {
        Lanes hub_rate = s.theta_dot;  // and the part of α̇ that the nodes resolve
        for (std::size_t i = 0; i < n; ++i) hub_rate += form->h[i] * s.resolved_rate(i);
        s.rate[kWorkDrive] = drive_torque_ * hub_rate;
    }
    if (!form->prescribed) return;
    Lanes follow{}, jerk{};  // Uᵀq; of the hub
    for (std::size_t i = 0; i < n; ++i) follow += form->U[i] * s.q[i];
    for (int l = 0; l < kNodes; ++l) jerk += (acceleration_[l] / s.h) * gauss.slope[static_cast<std::size_t>(l)];
    s.rate[kWorkDrive] = jerk * follow + (inertia_ ? drive_power_by_inertia() : drive_power_by_arrays());
    // The drive balances the moments of spring and contact.
    s.rate[kWorkDrive] -= s.theta_dot * torque;
    if (load) s.rate[kWorkDrive] -= s.theta_dot * load->torque();
}

// The power of the moments of inertia and gravity on the hub, but for Uᵀq̈.
Lanes NodalStep::drive_power_by_inertia() const {
    Lanes moment = forces_[0];
    for (std::size_t i = 0; i < n; ++i) moment -= form->U[i] * mode_acceleration_[i];
    return segment.theta_dot * moment;
}

Lanes NodalStep::drive_power_by_arrays() const {
    Lanes quadratic{}, fall{}, weighted{};
    for (std::size_t i = 0; i < n; ++i) {
        Lanes a{}, b{};
        for (std::size_t j = 0; j < n; ++j) {
            a += form->inertia[i * n + j] * segment.q[j];
            if (!form->fall.empty()) b += form->fall[i * n + j] * segment.q[j];
        }
        const Lanes& q = segment.q[i];
        quadratic += a * q;
        fall += b * q;
        weighted += form->weight[i] * q;
    }
    const Lanes gravity = form->gravity * (form->S * cos - form->mass * (weighted * sin + 0.5 * cos * fall));
    return segment.theta_dot * (gravity - (form->J + quadratic) * acceleration_);
}

}  // namespace beamcam::sim
