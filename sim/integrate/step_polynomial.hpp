// The polynomial of degree 7 through the values of a quantity at the nodes of a collocation step.
#pragma once

#include <array>

#include "sim/integrate/oscillator.hpp"

namespace beamcam::sim {

// Σ c_j zʲ with z = 2s − 1, so that dz/dt = 2/h in a step of length h [s].
template <std::size_t kCount>
struct StepPowers {
    std::array<double, kCount> c{};

    double operator()(double z) const {
        double value = 0;
        for (std::size_t j = kCount; j-- > 0;) value = value * z + c[j];
        return value;
    }
};

struct StepPolynomial : StepPowers<kNodes> {
    static StepPolynomial through(const Lanes& nodal);
    // Σ factors_j f⁽ʲ⁾
    static StepPolynomial of_derivatives(StepPolynomial f, const std::array<double, kNodes>& factors, double h);
    StepPolynomial derivative(double h) const;
    StepPowers<kNodes + 1> integral() const;  // ∫₀ˢ, for h = 1
};

// The motion that follows the forcing per mass f, given at the nodes, without vibration. Not for two decays.
StepPolynomial steady_motion(const Oscillator& oscillator, const Lanes& f, double h);

}  // namespace beamcam::sim
