// Natural frequencies and mode shapes of hub and beam, at rest with a free hub or rotating at a prescribed speed, by
// the Ritz method in the problem's own shapes. Without gravity and damping. MODEL.md §13.
#pragma once

#include <optional>
#include <vector>

#include "sim/base/vec2.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

struct Mode {
    double omega = 0;         // [rad/s]; NaN for a mode with negative stiffness (divergence)
    std::vector<Vec2> shape;  // (x, y): 101 points from the root, mass-normalized [m], [kg^−1/2]; y ≥ 0 at the tip
    std::vector<double> q;    // the coordinates of that shape, `size() − 1` of the model
};

// Without the rigid rotation. No `speed`: at rest, with a free hub (clamped if the drive prescribes its angle). With
// `speed` [rad/s]: in-plane vibration of a beam that is clamped to a hub rotating at this speed. Empty for a rigid
// beam.
std::vector<Mode> natural_modes(const Problem& problem, std::optional<double> speed = std::nullopt);

// The indices of those modes whose frequency changes by more than 1 % with 2 n + 4 shapes, at most 40, in place of the
// problem's n: they are not converged. Those of `exact` are compared with the shapes of `first-order`.
std::vector<std::size_t> unconverged_modes(const std::vector<Mode>& modes, const Problem& problem,
                                           std::optional<double> speed = std::nullopt);

}  // namespace beamcam::sim
