// The polynomial of degree 7 through the values of a quantity at the nodes of a collocation step.
#pragma once

#include <array>

#include "sim/integrate/oscillator.hpp"

namespace beamcam::sim {

// Σ c_j zʲ with z = 2s − 1, so that dz/dt = 2/h in a step of length h [s].
struct StepPolynomial {
    std::array<double, kNodes> c{};

    static StepPolynomial through(const Lanes& nodal);
    // Σ factors_j f⁽ʲ⁾
    static StepPolynomial of_derivatives(StepPolynomial f, const std::array<double, kNodes>& factors, double h);
    double operator()(double z) const;
    StepPolynomial derivative(double h) const;
    double bound() const;  // of its magnitude in the step
};

// The motion that follows the forcing per mass f, given at the nodes, without vibration. Not for two decays.
StepPolynomial steady_motion(const Oscillator& oscillator, const Lanes& f, double h);

}  // namespace beamcam::sim
