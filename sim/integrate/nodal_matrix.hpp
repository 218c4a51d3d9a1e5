// Matrices between the eight nodes of a collocation step: columns, in lanes over rows.
#pragma once

#include <array>
#include <span>

#include "sim/base/lanes.hpp"

namespace beamcam::sim {

using NodalMatrix = std::array<Lanes, kNodes>;

// Solves a x = b for each b, b ← x, with partial pivoting; a is overwritten. False: a is singular.
// BENCHMARKS.md compares it with Eigen.
bool solve_dense(NodalMatrix& a, std::span<Lanes> b);

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

}  // namespace beamcam::sim
