// The energy balance within a step of the exponential collocation, including vibration that the nodes do not resolve.
// MODEL.md §12.
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

const ExponentialSegment::VibrationWorks& ExponentialSegment::vibration_works() const {
    VibrationWorks& works = vibration_works_;
    if (vibration_works_known_) return works;
    vibration_works_known_ = true;
    works.forcing.assign(n_, std::nullopt);
    works.torque.assign(n_, std::nullopt);
    Lanes torque;
    for (int k = 0; k < kNodes; ++k) torque[k] = drive_.torque(t0 + h * Collocation::get().c[k]);
    for (std::size_t i = 0; i < n_; ++i) {
        const Oscillator& o = form_->oscillators[i];
        if (resolved(o, h)) continue;
        if (o.gamma > 0) works.forcing[i].emplace(o, f[i], f[i], h, VibrationWork::Position{q0[i], v0[i]});
        if (drive_.has_torque()) works.torque[i].emplace(o, torque, f[i], h, VibrationWork::Position{q0[i], v0[i]});
    }
    return works;
}

// Loss of one mode up to s: the fall of its energy and the work of the forcing, ∫2γmv² = m{E(0) − E(t) + ∫f v},
// E = ½(v² + ω²q²).                                       (S54)
double ExponentialSegment::structural_loss(std::size_t i, double s, const double* y) const {
    const Oscillator& o = form_->oscillators[i];
    if (o.gamma == 0) return 0;
    const double w2 = o.omega * o.omega, x1 = y[1 + i], dx1 = y[2 + n_ + i];
    const double fell = 0.5 * (v0[i] * v0[i] - dx1 * dx1 + w2 * (q0[i] * q0[i] - x1 * x1));
    const std::optional<VibrationWork>& of_forcing = vibration_works().forcing[i];
    if (!of_forcing) return form_->mass * fell;
    const double z = 2 * s - 1;
    return form_->mass * (fell + (*of_forcing)(z, {x1, dx1}));
}

// Work of the torque on the part of the vibration α̇ that the nodes do not resolve.
double ExponentialSegment::torque_on_vibration(double s, const double* y) const {
    double work = 0;
    for (std::size_t i = 0; i < n_; ++i)
        if (const auto& of_torque = vibration_works().torque[i])
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
    if (form_->by_arrays()) {
        double inertia = form_->J;
        for (std::size_t i = 0; i < n_; ++i) {
            double row = 0;
            for (std::size_t j = 0; j < n_; ++j) row += form_->inertia[i * n_ + j] * y[1 + j];
            inertia += row * y[1 + i];
        }
        momentum += inertia * hub.rate;
    }
    return hub.rate * momentum - hub.acceleration * follow;
}

void ExponentialSegment::set_ledger(const Lanes& weights, double* y) const {
    for (int k = 0; k < kLedgerSize; ++k)
        y[controlled_ + static_cast<std::size_t>(k)] = ledger0[k] + h * sum(weights * rate[k]);
}

void ExponentialSegment::add_vibration_work(double t, double s, double* y) const {
    double* ledger = y + controlled_;
    if (form_->damped)
        for (std::size_t i = 0; i < n_; ++i) ledger[kLossStructural] += structural_loss(i, s, y);
    if (drive_.has_torque()) ledger[kWorkDrive] += torque_on_vibration(s, y);
    if (form_->prescribed) ledger[kWorkDrive] += drive_boundary(t, y) - boundary0;
}

}  // namespace beamcam::sim
