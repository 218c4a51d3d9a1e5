// The state at t = 0: straight or as given, in static equilibrium with the hub held, or resting on the cam.
#pragma once

#include <vector>

#include "sim/dynamics/system.hpp"

namespace beamcam::sim {

struct InitialState {
    std::vector<double> y;  // of the system's `size`
    Phase phase;
    bool left_behind = false;  // no motion along the turning cam was found: it is the beam at rest that moves along
};

// Throws StepFailure when no equilibrium is found. MODEL.md §11.
InitialState initial_state(const Problem& problem);
// The same with a system of that problem at hand, which is copied.
InitialState initial_state(const System& of);

// What a problem says to begin in a state of the system, of its `size`, that does not touch the cam.
Initial initial_of(const System& of, const std::vector<double>& y);

}  // namespace beamcam::sim
