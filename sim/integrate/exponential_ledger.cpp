// The energy balance within a step of the exponential collocation, including vibration that the nodes do not resolve.
// MODEL.md §12.
#include <array>
#include <cmath>
#include <utility>

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

// Σ c_j zʲ with z = 2s − 1, so that dz/dt = 2/h.
struct ExponentialSegment::Polynomial {
    std::array<double, kNodes> c{};

    static Polynomial through(const Lanes& nodal) {
        Polynomial p;
        for (std::size_t j = 0; j < kNodes; ++j) p.c[j] = sum(Collocation::get().monomial[j] * nodal);
        return p;
    }
    double operator()(double z) const {
        double value = 0;
        for (std::size_t j = kNodes; j-- > 0;) value = value * z + c[j];
        return value;
    }
    void add(double factor, const Polynomial& p) {
        for (std::size_t j = 0; j < kNodes; ++j) c[j] += factor * p.c[j];
    }
    Polynomial derivative(double h) const {
        Polynomial d;
        for (std::size_t j = 0; j + 1 < kNodes; ++j) d.c[j] = static_cast<double>(j + 1) * c[j + 1] * (2 / h);
        return d;
    }
};

// ∫ a b dt, from z = 0 on.
struct ExponentialSegment::ProductIntegral {
    std::array<double, 2 * kNodes> c{};

    ProductIntegral(const Polynomial& a, const Polynomial& b, double h) {
        for (std::size_t i = 0; i < kNodes; ++i)
            for (std::size_t j = 0; j < kNodes; ++j) c[i + j + 1] += a.c[i] * b.c[j];
        for (std::size_t k = 1; k < c.size(); ++k) c[k] *= 0.5 * h / static_cast<double>(k);
    }
    double operator()(double z) const {
        double value = 0;
        for (std::size_t k = c.size(); k-- > 0;) value = value * z + c[k];
        return value;
    }
};

// ∫₀ˢ g q̇ for a polynomial g and the part of q̇ that the nodes do not resolve.
double ExponentialSegment::work_on(std::size_t i, const Polynomial& g, double s, const double* y) const {
    if (!decays(form_->oscillators[i])) return work_on_vibration(i, g, s, y);
    const double fast = work_on_decay(i, true, g, s, y);
    const bool slow_resolved = decays_of(form_->oscillators[i]).slow * h < kResolvedRadians;
    return slow_resolved ? fast : fast + work_on_decay(i, false, g, s, y);
}

// The part −r x of q̇: ẋ = −rx + cf has a polynomial solution; the decaying rest is integrated by parts.      (S52a)
double ExponentialSegment::work_on_decay(std::size_t i, bool fast, const Polynomial& g, double s,
                                         const double* y) const {
    const Decays d = decays_of(form_->oscillators[i]);
    const double r = fast ? d.fast : d.slow, other = fast ? d.slow : d.fast, c = (fast ? -1 : 1) / d.apart();
    Polynomial particular, derived = Polynomial::through(f[i]);
    double factor = c / r;
    for (int k = 0; k < kNodes; ++k, factor /= -r) {
        particular.add(factor, derived);
        derived = derived.derivative(h);
    }
    const ProductIntegral steady(g, particular, h);
    const auto integral = [&](double z, double x) {
        double total = steady(z);
        x -= particular(z);
        Polynomial poly = g;
        for (int k = 0; k < kNodes; ++k) {
            x /= r;
            total -= poly(z) * x;
            poly = poly.derivative(h);
        }
        return total;
    };
    const double x0 = c * (v0[i] + other * q0[i]), x1 = c * (y[2 + n_ + i] + other * y[1 + i]);
    return -r * (integral(2 * s - 1, x1) - integral(-1, x0));
}

// The motion that follows the forcing f without vibration: Σ c_j f⁽ʲ⁾, a polynomial.
ExponentialSegment::Polynomial ExponentialSegment::steady_motion(std::size_t i) const {
    Polynomial steady, derived = Polynomial::through(f[i]);
    for (const double c : following(form_->oscillators[i])) {
        steady.add(c, derived);
        derived = derived.derivative(h);
    }
    return steady;
}

// Below critical damping: the free vibration v_h about the steady motion is integrated by parts against g.  (S54)
double ExponentialSegment::work_on_vibration(std::size_t i, const Polynomial& g, double s, const double* y) const {
    const Oscillator& o = form_->oscillators[i];
    const double w2 = o.omega * o.omega;
    const Polynomial steady = steady_motion(i), speed = steady.derivative(h);
    const ProductIntegral of_steady(g, speed, h);
    const auto integral = [&](double z, double x, double dx) {
        double total = of_steady(z);
        double low = dx - speed(z), high = x - steady(z);  // V₀ = v_h, V₁ = q_h, V_{k+1} = −(V_{k−1} + 2γV_k)/ω²
        Polynomial poly = g;
        for (int k = 0; k < kNodes; ++k) {
            total += (k % 2 ? -1 : 1) * poly(z) * high;
            poly = poly.derivative(h);
            low = std::exchange(high, -(low + 2 * o.gamma * high) / w2);
        }
        return total;
    };
    return integral(2 * s - 1, y[1 + i], y[2 + n_ + i]) - integral(-1, q0[i], v0[i]);
}

// Loss of one mode up to s: the fall of its energy and the work of the forcing, ∫2γmv² = m{E(0) − E(t) + ∫f v},
// E = ½(v² + ω²q²). The forcing κw of a fast vibration does the work ½κw².                           (S54), (S52b)
double ExponentialSegment::structural_loss(std::size_t i, double s, const double* y) const {
    const Oscillator& o = form_->oscillators[i];
    if (o.gamma == 0) return 0;
    const double w2 = o.omega * o.omega, x1 = y[1 + i], dx1 = y[2 + n_ + i];
    const double fell = 0.5 * (v0[i] * v0[i] - dx1 * dx1 + w2 * (q0[i] * q0[i] - x1 * x1));
    if (resolved(i)) return form_->mass * fell;
    double work = work_on(i, Polynomial::through(f[i]), s, y);
    if (left_out.contains(i)) {
        const Polynomial steady = steady_motion(i);
        const double last = x1 - steady(2 * s - 1), start = q0[i] - steady(-1);
        work += 0.5 * left_out.stiffness(i) * (last * last - start * start);
    }
    return form_->mass * (fell + work);
}

// Work of the torque on the part of the vibration α̇ that the nodes do not resolve.
double ExponentialSegment::torque_on_vibration(double s, const double* y) const {
    const Collocation& gauss = Collocation::get();
    Lanes torque;
    for (int k = 0; k < kNodes; ++k) torque[k] = drive_.torque(t0 + h * gauss.c[k]);
    const Polynomial polynomial = Polynomial::through(torque);
    double work = 0;
    for (std::size_t i = 0; i < n_; ++i)
        if (!resolved(i)) work += form_->h[i] * work_on(i, polynomial, s, y);
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
