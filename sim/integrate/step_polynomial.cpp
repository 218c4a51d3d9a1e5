#include "sim/integrate/step_polynomial.hpp"

namespace beamcam::sim {

StepPolynomial StepPolynomial::through(const Lanes& nodal) {
    StepPolynomial p;
    for (std::size_t j = 0; j < kNodes; ++j) p.c[j] = sum(Collocation::get().monomial[j] * nodal);
    return p;
}

StepPolynomial StepPolynomial::of_derivatives(StepPolynomial f, const std::array<double, kNodes>& factors, double h) {
    StepPolynomial p;
    for (const double factor : factors) {
        for (std::size_t j = 0; j < kNodes; ++j) p.c[j] += factor * f.c[j];
        f = f.derivative(h);
    }
    return p;
}

StepPolynomial StepPolynomial::derivative(double h) const {
    StepPolynomial d;
    for (std::size_t j = 0; j + 1 < kNodes; ++j) d.c[j] = static_cast<double>(j + 1) * c[j + 1] * (2 / h);
    return d;
}

StepPowers<kNodes + 1> StepPolynomial::integral() const {
    StepPowers<kNodes + 1> p;
    for (std::size_t j = 0; j < kNodes; ++j) {
        p.c[j + 1] = c[j] / (2 * (static_cast<double>(j) + 1));
        p.c[0] += j % 2 ? -p.c[j + 1] : p.c[j + 1];
    }
    return p;
}

StepPolynomial steady_motion(const Oscillator& oscillator, const Lanes& f, double h) {
    return StepPolynomial::of_derivatives(StepPolynomial::through(f), following(oscillator), h);
}

}  // namespace beamcam::sim
