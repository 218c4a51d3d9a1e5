// The state at t = 0: straight or with given coordinates, in static equilibrium with the hub clamped, or in equilibrium
// on the cam. MODEL.md §11.
#pragma once

#include <vector>

#include "sim/dynamics/system.hpp"

namespace beamcam::sim {

struct InitialState {
    std::vector<double> y;  // System::size numbers
    Phase phase;
    // A resting beam starts from the equilibrium without inertia, because the cam is too fast.
    bool left_behind = false;
    bool unstable = false;  // the static equilibrium: the beam has buckled under its weight
};

// Throws StepFailure if no equilibrium is found.
InitialState initial_state(const Problem& problem);
InitialState initial_state(const System& system);  // copies the system

// The `initial` of a problem that starts in the state y without contact.
Initial initial_of(const System& system, const std::vector<double>& y);

}  // namespace beamcam::sim
