#include "sim/integrate/vibration_work.hpp"

#include <cmath>
#include <utility>

namespace beamcam::sim {

VibrationWork::ProductIntegral VibrationWork::integral_of_product(const StepPolynomial& a, const StepPolynomial& b,
                                                                  double h) {
    ProductIntegral p;
    for (std::size_t i = 0; i < kNodes; ++i)
        for (std::size_t j = 0; j < kNodes; ++j) p.c[i + j + 1] += a.c[i] * b.c[j];
    for (std::size_t k = 1; k < p.c.size(); ++k) p.c[k] *= 0.5 * h / static_cast<double>(k);
    return p;
}

bool resolved(const Oscillator& o, double h) {
    return (decays(o) ? decays_of(o).fast : o.omega) * h < kResolvedRadians;
}

VibrationWork::VibrationWork(const Oscillator& oscillator, const Lanes& g, const Lanes& f, double h, Position start)
    : oscillator_(oscillator) {
    g_[0] = StepPolynomial::through(g);
    for (std::size_t k = 1; k < g_.size(); ++k) g_[k] = g_[k - 1].derivative(h);
    if (decays(oscillator)) {
        add_decay(true, f, h, start);
        if (decays_of(oscillator).slow * h >= kResolvedRadians) add_decay(false, f, h, start);
        return;
    }
    const StepPolynomial steady = steady_motion(oscillator, f, h), speed = steady.derivative(h);
    vibration_ = Vibration{steady, speed, integral_of_product(g_[0], speed, h)};
    vibration_->at_start = integral(*vibration_, -1, start);
}

void VibrationWork::add_decay(bool fast, const Lanes& f, double h, Position start) {
    const Decays d = decays_of(oscillator_);
    const double r = fast ? d.fast : d.slow, c = (fast ? -1 : 1) / d.apart();
    std::array<double, kNodes> factors{c / r};
    for (std::size_t k = 1; k < factors.size(); ++k) factors[k] = factors[k - 1] / -r;
    const StepPolynomial steady = StepPolynomial::of_derivatives(StepPolynomial::through(f), factors, h);
    Decay decay{r, fast ? d.slow : d.fast, c, steady, integral_of_product(g_[0], steady, h)};
    decay.at_start = integral(decay, -1, start);
    decays_.push_back(decay);
}

// The free vibration v_h about the steady motion is integrated by parts against g.                          (S54)
double VibrationWork::integral(const Vibration& of, double z, Position at) const {
    const Oscillator& o = oscillator_;
    double total = of.on_steady(z);
    double low = at.rate - of.speed(z);  // V₀ = v_h, V₁ = q_h, V_{k+1} = −(V_{k−1} + 2γV_k)/ω²
    double high = at.q - of.steady(z);
    for (std::size_t k = 0; k < g_.size(); ++k) {
        total += (k % 2 ? -1 : 1) * g_[k](z) * high;
        low = std::exchange(high, -(low + 2 * o.gamma * high) / (o.omega * o.omega));
    }
    return total;
}

double VibrationWork::integral(const Decay& of, double z, Position at) const {
    double total = of.on_steady(z), x = of.part(at) - of.steady(z);
    for (const StepPolynomial& g : g_) {
        x /= of.rate;
        total -= g(z) * x;
    }
    return total;
}

double VibrationWork::operator()(double z, Position now) const {
    if (vibration_) return integral(*vibration_, z, now) - vibration_->at_start;
    double work = 0;
    for (const Decay& decay : decays_) work += -decay.rate * (integral(decay, z, now) - decay.at_start);
    return work;
}

}  // namespace beamcam::sim
