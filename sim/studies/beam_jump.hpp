// The speed at which the beam itself leaves the cam, found by simulation: it starts at rest on the cam and follows it
// for some turns.
#pragma once

#include <optional>

#include "sim/run/simulate.hpp"

namespace beamcam::sim {

// The beam stays on the cam at `follows` and leaves it at `leaves` [rad/s]; they differ by 1e-5 of the speed.
struct BeamJump {
    double follows = 0, leaves = 0;
};

// Searches upwards from a quarter of the speed `around` up to twice it; nothing: the beam follows the cam up to there.
// The problem has a turning cam and a free hub. `progress` receives the number of the motion. Throws SolverError where
// a motion cannot be integrated, Interrupted.
std::optional<BeamJump> beam_jump(const Problem& problem, double around, const Progress& progress = {});

}  // namespace beamcam::sim
