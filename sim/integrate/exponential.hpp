// Exponential Gauss collocation: the oscillators of the beam are propagated exactly for a forcing that is the
// interpolation polynomial through eight nodal values, so a step spans many periods of vibration.
// MODEL.md §12. Phases that it does not cover are integrated by Runge–Kutta (rk8.cpp) or BDF.
#pragma once

#include <memory>

#include "sim/dynamics/system.hpp"
#include "sim/integrate/integrator.hpp"

namespace beamcam::sim {

// Integrates `system`, whose phase is read at every `start`.
std::unique_ptr<Integrator> make_exponential(System& system, double rtol, double atol);

}  // namespace beamcam::sim
