// The energy balance within a step of the exponential collocation, including vibration that the nodes do not resolve.
// MODEL.md §12.
#include <algorithm>
#include <optional>

#include "sim/integrate/exponential_segment.hpp"

namespace beamcam::sim {

Lanes ExponentialSegment::resolved_rate(std::size_t i) const {
    const Oscillator& o = form_->oscillators[i];
    if (resolved(o, h)) return v[i];
    if (!decays(o)) return Lanes{};
    const Decays d = decays_of(o);
    return d.slow * h < kResolvedRadians ? (-d.slow / d.apart()) * (v[i] + d.fast * q[i]) : Lanes{};
}

void ExponentialSegment::prepare_vibration_work() {
    forcing_work_.assign(n_, std::nullopt);
    torque_work_.assign(n_, std::nullopt);
    Lanes torque;
    for (int k = 0; k < kNodes; ++k) torque[k] = drive_.torque(t0 + h * Collocation::get().c[k]);
    for (std::size_t i = 0; i < n_; ++i) {
        const Oscillator& o = form_->oscillators[i];
        if (resolved(o, h)) continue;
        const VibrationWork::Position start{q0[i], v0[i]};
        if (o.gamma > 0) forcing_work_[i].emplace(o, f[i], f[i], h, start);
        if (drive_.has_torque()) torque_work_[i].emplace(o, torque, f[i], h, start);
    }
}

// Loss of one mode up to s: the fall of its energy and the work of the forcing, ∫2γmv² = m{E(0) − E(t) + ∫f v},
// E = ½(v² + ω²q²).                                       (S54)
double ExponentialSegment::structural_loss(std::size_t i, double s, const double* y) const {
    const Oscillator& o = form_->oscillators[i];
    if (o.gamma == 0) return 0;
    const double w2 = o.omega * o.omega, x1 = y[1 + i], dx1 = y[2 + n_ + i];
    const double fell = 0.5 * (v0[i] * v0[i] - dx1 * dx1 + w2 * (q0[i] * q0[i] - x1 * x1));
    return form_->mass * (forcing_work_[i] ? fell + (*forcing_work_[i])(2 * s - 1, {x1, dx1}) : fell);
}

// Work of the torque on the part of the vibration α̇ that the nodes do not resolve.
double ExponentialSegment::torque_on_vibration(double s, const double* y) const {
    double work = 0;
    for (std::size_t i = 0; i < n_; ++i)
        if (const auto& of_torque = torque_work_[i])
            work += form_->h[i] * (*of_torque)(2 * s - 1, {y[1 + i], y[2 + n_ + i]});
    return work;
}

double ExponentialSegment::drive_boundary(double t, const double* y) const {
    if (!form_->prescribed) return 0;
    const HubMotion hub = drive_.motion(t);
    double momentum = 0, follow = 0;
    for (std::size_t i = 0; i < n_; ++i) {
        momentum += form_->U[i] * y[2 + n_ + i];
        follow += form_->U[i] * y[1 + i];
    }
    if (form_->by_arrays()) momentum += inertia(y + 1) * hub.rate;
    return hub.rate * momentum - hub.acceleration * follow;
}

void ExponentialSegment::put_ledger(double t, double s, double* y) const {
    double* ledger = y + controlled_;
    std::copy_n(ledger0, kLedgerSize, ledger);
    if (!ledger_changes) return;
    const Lanes weights = Collocation::get().weights_to(s);
    for (int k = 0; k < kLedgerSize; ++k) ledger[k] += h * sum(weights * rate[k]);
    if (form_->damped)
        for (std::size_t i = 0; i < n_; ++i) ledger[kLossStructural] += structural_loss(i, s, y);
    if (drive_.has_torque()) ledger[kWorkDrive] += torque_on_vibration(s, y);
    if (form_->prescribed) ledger[kWorkDrive] += drive_boundary(t, y) - boundary0;
}

}  // namespace beamcam::sim
