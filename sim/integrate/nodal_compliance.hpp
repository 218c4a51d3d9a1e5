// Matrices between the eight nodes of a collocation step: columns, in lanes over rows. How a displacement [m/N] and its
// rate [m/(N s)] at the nodes respond to nodal forces.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/base/lanes.hpp"
#include "sim/integrate/oscillator.hpp"

namespace beamcam::sim {

using NodalMatrix = std::array<Lanes, kNodes>;

// Solves a x = b for each b, b ← x. False: a is singular.
bool solve_dense(NodalMatrix a, std::span<Lanes> b);

inline Lanes operator*(const NodalMatrix& a, const Lanes& x) {
    Lanes y{};
    for (int l = 0; l < kNodes; ++l) y += a[static_cast<std::size_t>(l)] * x[l];
    return y;
}
inline NodalMatrix operator*(const NodalMatrix& a, const NodalMatrix& b) {
    NodalMatrix c;
    for (std::size_t l = 0; l < kNodes; ++l) c[l] = a * b[l];
    return c;
}

struct NodalCompliance {
    NodalMatrix value, rate;  // columns by force
};
// The displacement in a direction with the rows a of the modes by forces in that with the rows b, or the other way
// round. `hub`: the product of both rows of the hub over its inertia.
NodalCompliance nodal_compliance(const StepTable& table, double mass, double hub, const std::vector<double>& a,
                                 const std::vector<double>& b);

}  // namespace beamcam::sim
