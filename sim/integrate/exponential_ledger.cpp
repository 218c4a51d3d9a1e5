// The energy balance within a step of the exponential collocation, including vibration that the nodes do not resolve.
// MODEL.md §12.
#include <algorithm>
#include <cmath>

#include "sim/integrate/constants.hpp"
#include "sim/integrate/exponential_segment.hpp"

namespace beamcam::sim {

bool ExponentialSegment::resolved(std::size_t i) const {
    const Oscillator& o = form_->oscillators[i];
    return (decays(o) ? decays_of(o).fast : o.omega) * h < kResolvedRadians;
}

Lanes ExponentialSegment::resolved_rate(std::size_t i) const {
    if (resolved(i)) return v[i];
    if (!decays(form_->oscillators[i])) return Lanes{};
    const Decays d = decays_of(form_->oscillators[i]);
    return d.slow * h < kResolvedRadians ? (-d.slow / d.apart()) * (v[i] + d.fast * q[i]) : Lanes{};
}

// ∫₀ˢ g q̇ for a polynomial g(z), z = 2s − 1, and the part of q̇ that the nodes do not resolve.
double ExponentialSegment::work_on(std::size_t i, const double* g, double s, const double* y) const {
    if (!decays(form_->oscillators[i])) return work_on_vibration(i, g, s, y);
    const double fast = work_on_decay(i, true, g, s, y);
    const bool slow_resolved = decays_of(form_->oscillators[i]).slow * h < kResolvedRadians;
    return slow_resolved ? fast : fast + work_on_decay(i, false, g, s, y);
}

// The part −r x of q̇: ẋ = −rx + cf has a polynomial solution; the decaying rest is integrated by parts.      (S52a)
double ExponentialSegment::work_on_decay(std::size_t i, bool fast, const double* g, double s, const double* y) const {
    const Decays d = decays_of(form_->oscillators[i]);
    const double r = fast ? d.fast : d.slow, other = fast ? d.slow : d.fast, c = (fast ? -1 : 1) / d.apart();
    double particular[kNodes] = {}, derived[kNodes];
    for (std::size_t j = 0; j < kNodes; ++j) derived[j] = sum(Collocation::get().monomial[j] * f[i]);
    const auto derive = [&](double* polynomial) {
        for (int j = 0; j + 1 < kNodes; ++j) polynomial[j] = (j + 1) * polynomial[j + 1] * (2 / h);
        polynomial[kNodes - 1] = 0;
    };
    double factor = c / r;
    for (int k = 0; k < kNodes; ++k) {
        for (int j = 0; j < kNodes; ++j) particular[j] += factor * derived[j];
        derive(derived);
        factor /= -r;
    }
    const auto integral = [&](double z, double x) {
        double power[2 * kNodes];
        power[0] = 1;
        for (int j = 1; j < 2 * kNodes; ++j) power[j] = power[j - 1] * z;
        double total = 0;
        for (int a = 0; a < kNodes; ++a) {
            x -= particular[a] * power[a];
            for (int b = 0; b < kNodes; ++b) total += g[a] * particular[b] * power[a + b + 1] / (a + b + 1);
        }
        total *= 0.5 * h;
        double poly[kNodes];
        std::copy_n(g, kNodes, poly);
        for (int k = 0; k < kNodes; ++k) {
            double value = 0;
            for (int j = 0; j < kNodes; ++j) value += poly[j] * power[j];
            x /= r;
            total -= value * x;
            derive(poly);
        }
        return total;
    };
    const double x0 = c * (v0[i] + other * q0[i]), x1 = c * (y[2 + n_ + i] + other * y[1 + i]);
    return -r * (integral(2 * s - 1, x1) - integral(-1, x0));
}

// Below critical damping: the particular solution is a polynomial, and the free vibration v_h is integrated by parts
// against g.                                                                                              (S54)
double ExponentialSegment::work_on_vibration(std::size_t i, const double* g, double s, const double* y) const {
    const Oscillator& o = form_->oscillators[i];
    const double w2 = o.omega * o.omega, x1 = y[1 + i], dx1 = y[2 + n_ + i];
    double particular[kNodes] = {}, speed[kNodes] = {}, derived[kNodes];
    for (std::size_t j = 0; j < kNodes; ++j) derived[j] = sum(Collocation::get().monomial[j] * f[i]);
    double c = 1 / w2, before = 0;
    for (int k = 0; k < kNodes; ++k) {
        for (int j = 0; j < kNodes; ++j) particular[j] += c * derived[j];
        for (int j = 0; j + 1 < kNodes; ++j) derived[j] = (j + 1) * derived[j + 1] * (2 / h);
        derived[kNodes - 1] = 0;
        for (int j = 0; j < kNodes; ++j) speed[j] += c * derived[j];
        const double next = -(2 * o.gamma * c + before) / w2;
        before = c;
        c = next;
    }
    const auto integral = [&](double z, double x, double dx) {
        double power[2 * kNodes];
        power[0] = 1;
        for (int j = 1; j < 2 * kNodes; ++j) power[j] = power[j - 1] * z;
        double total = 0, qp = 0, vp = 0;
        for (int a = 0; a < kNodes; ++a) {
            qp += particular[a] * power[a];
            vp += speed[a] * power[a];
            for (int b = 0; b < kNodes; ++b) total += g[a] * speed[b] * power[a + b + 1] / (a + b + 1);
        }
        total *= 0.5 * h;
        double poly[kNodes];
        std::copy_n(g, kNodes, poly);
        double low = dx - vp, high = x - qp, sign = 1;  // V₀ = v_h, V₁ = q_h, V_{k+1} = −(V_{k−1} + 2γV_k)/ω²
        for (int k = 0; k < kNodes; ++k) {
            double value = 0;
            for (int j = 0; j < kNodes; ++j) value += poly[j] * power[j];
            total += sign * value * high;
            sign = -sign;
            for (int j = 0; j + 1 < kNodes; ++j) poly[j] = (j + 1) * poly[j + 1] * (2 / h);
            poly[kNodes - 1] = 0;
            const double next = -(low + 2 * o.gamma * high) / w2;
            low = high;
            high = next;
        }
        return total;
    };
    return integral(2 * s - 1, x1, dx1) - integral(-1, q0[i], v0[i]);
}

// Loss of one mode up to s: the fall of its energy and the work of the forcing, ∫2γmv² = m{E(0) − E(t) + ∫f v},
// E = ½(v² + ω²q²). The forcing κw of a fast vibration does the work ½κw².                           (S54), (S52b)
double ExponentialSegment::structural_loss(std::size_t i, double s, const double* y) const {
    const Oscillator& o = form_->oscillators[i];
    if (o.gamma == 0) return 0;
    const double w2 = o.omega * o.omega, x1 = y[1 + i], dx1 = y[2 + n_ + i];
    const double fell = 0.5 * (v0[i] * v0[i] - dx1 * dx1 + w2 * (q0[i] * q0[i] - x1 * x1));
    if (resolved(i)) return form_->mass * fell;
    double force[kNodes];
    for (std::size_t j = 0; j < kNodes; ++j) force[j] = sum(Collocation::get().monomial[j] * f[i]);
    double work = work_on(i, force, s, y);
    if (left_out.contains(i)) {
        double last = x1, start = q0[i], power = 1 / w2, sign = 1 / w2;
        for (int j = 0; j < kNodes; ++j, power *= 2 * s - 1, sign = -sign) {
            last -= force[j] * power;
            start -= force[j] * sign;
        }
        work += 0.5 * left_out.stiffness(i) * (last * last - start * start);
    }
    return form_->mass * (fell + work);
}

// Work of the torque on the part of the vibration α̇ that the nodes do not resolve.
double ExponentialSegment::torque_on_vibration(double s, const double* y) const {
    const Collocation& gauss = Collocation::get();
    Lanes torque;
    for (int k = 0; k < kNodes; ++k) torque[k] = drive_.torque(t0 + h * gauss.c[k]);
    double polynomial[kNodes], work = 0;
    for (std::size_t j = 0; j < kNodes; ++j) polynomial[j] = sum(gauss.monomial[j] * torque);
    for (std::size_t i = 0; i < n_; ++i)
        if (!resolved(i)) work += form_->h[i] * work_on(i, polynomial, s, y);
    return work;
}

double ExponentialSegment::drive_boundary(double t, const double* y) const {
    if (!form_->prescribed) return 0;
    const HubMotion hub = drive_.motion(t);
    double momentum = form_->J * hub.rate, follow = 0;
    for (std::size_t i = 0; i < n_; ++i) {
        double row = 0;
        for (std::size_t j = 0; j < n_; ++j) row += form_->inertia[i * n_ + j] * y[1 + j];
        momentum += row * y[1 + i] * hub.rate + form_->U[i] * y[2 + n_ + i];
        follow += form_->U[i] * y[1 + i];
    }
    return hub.rate * momentum - hub.acceleration * follow;
}

void ExponentialSegment::ledger_at(double t, double s, const Lanes& weights, double* y) const {
    double* ledger = y + controlled_;
    for (int k = 0; k < kLedgerSize; ++k) ledger[k] = ledger0[k] + h * sum(weights * rate[k]);
    if (form_->damped)
        for (std::size_t i = 0; i < n_; ++i) ledger[kLossStructural] += structural_loss(i, s, y);
    if (drive_.has_torque()) ledger[kWorkDrive] += torque_on_vibration(s, y);
    if (form_->prescribed) ledger[kWorkDrive] += drive_boundary(t, y) - boundary0;
}

}  // namespace beamcam::sim
