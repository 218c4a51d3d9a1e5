#include "sim/integrate/exponential_segment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace beamcam::sim {

ExponentialSegment::ExponentialSegment(std::shared_ptr<const ModalForm> modal_form, const DriveLaw& drive_law,
                                       int state_size)
    : form_(std::move(modal_form)), drive_(drive_law), n_(static_cast<std::size_t>(form_->n)) {
    controlled_ = static_cast<std::size_t>(state_size) - kLedgerSize;
    q0.resize(n_);
    v0.resize(n_);
    q.resize(n_);
    v.resize(n_);
    f.resize(n_);
    end.resize(static_cast<std::size_t>(state_size));
}

double ExponentialSegment::inertia(const double* x) const {
    double bq[kMaxModes] = {}, total = form_->J;  // B is symmetric
    const double* column = form_->inertia.data();
    for (std::size_t j = 0; j < n_ && column; ++j, column += n_)
        for (std::size_t i = 0; i < n_; ++i) bq[i] += column[i] * x[j];
    for (std::size_t i = 0; i < n_; ++i) total += bq[i] * x[i];
    return total;
}

void ExponentialSegment::integrate_hub() {
    turn_ = StepPolynomial::through(theta_dot).integral();
    momentum_ = StepPolynomial::through(p_dot).integral();
}

// The start of the step or the last node before t = t0 + sh, or at t but for its rounding.
std::size_t ExponentialSegment::last_point(double t, double s) const {
    const Collocation& gauss = Collocation::get();
    const double at = s + std::numeric_limits<double>::epsilon() * std::fabs(t) / h;
    std::size_t point = 0;
    while (point < kNodes && gauss.point[point + 1] <= at) ++point;
    return point;
}

// q and q̇ of the modes at t = t0 + sh, from the last point before.
void ExponentialSegment::evolve(double t, double s, double* y) const {
    const std::size_t point = last_point(t, s);
    const double tau = (s - Collocation::get().point[point]) * h;
    double *x = y + 1, *dx = y + 2 + n_;
    for (std::size_t i = 0; i < n_; ++i) {
        const int node = static_cast<int>(point) - 1;
        x[i] = point == 0 ? q0[i] : q[i][node];
        dx[i] = point == 0 ? v0[i] : v[i][node];
    }
    if (!(tau > std::numeric_limits<double>::epsilon() * std::fabs(t))) return;
    const Derivatives derive = derivatives_at(point, h);
    for (std::size_t i = 0; i < n_; ++i) {
        const Propagation p = propagate(form_->oscillators[i], derive, tau);
        const double from = x[i];
        x[i] = p.qq * from + p.qv * dx[i] + sum(p.forced_q * f[i]);
        dx[i] = p.vq * from + p.vv * dx[i] + sum(p.forced_v * f[i]);
    }
}

void ExponentialSegment::value(double t, double* y) const {
    if (t == t1)
        std::copy(end.begin(), end.end(), y);
    else
        value_inside(t, y);
}

// The modes and the frame, with their rates.
void ExponentialSegment::evaluate(double t, double* y) const {
    const double s = (t - t0) / h;
    double* rates = y + 1 + n_;
    evolve(t, s, y);
    if (form_->prescribed) {
        const HubMotion motion = drive_.motion(t);
        y[0] = motion.angle;
        rates[0] = motion.rate;
    } else {
        y[0] = theta0 + h * turn_(2 * s - 1);
        rates[0] = (p0 + h * momentum_(2 * s - 1)) / inertia(y + 1);
    }
}

void ExponentialSegment::motion_inside(double t, double* y) const {
    evaluate(t, y);
    form_->to_coordinates(y);
}

void ExponentialSegment::value_inside(double t, double* y) const {
    const double s = (t - t0) / h;
    evaluate(t, y);
    if (has_bristle())
        y[2 * (n_ + 1)] =
            touching ? bristle0 + h * sum(Collocation::get().weights_to(s) * bristle_rate) : end[2 * (n_ + 1)];
    put_ledger(t, s, y);
    form_->to_coordinates(y);
}

// ---- the energy balance, including vibration that the nodes do not resolve ----------------------------------

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
