// Natural frequencies and shapes of hub and beam, at rest with a free hub or turning at a held speed:
// Ritz in the problem's own basis, count and model, without gravity and damping. MODEL.md §13.
#pragma once

#include <optional>
#include <vector>

#include "sim/base/vec2.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

struct Mode {
    double omega = 0;         // [rad/s]; NaN where the stiffness is lost (diverging mode)
    std::vector<Vec2> shape;  // (x, y): 101 points from the root, mass-normalized [m], [kg^−1/2]
};

// Each has the sign of the scene's own coordinate that it is mostly made of. Rigid rotation is left out. `speed`
// absent: at rest, the hub free with its inertia (held when the drive prescribes its angle). Present: the beam turns at
// that speed [rad/s] in the plane of rotation, clamped to a hub held at it. Empty for a rigid beam.
std::vector<Mode> natural_modes(const Problem& problem, std::optional<double> speed = std::nullopt);

}  // namespace beamcam::sim
