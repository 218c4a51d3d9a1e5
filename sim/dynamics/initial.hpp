// The state at t = 0: straight or with given coordinates, in static equilibrium with the hub clamped, or in equilibrium
// on the cam; and the problem that continues a motion. MODEL.md §11.
#pragma once

#include <optional>
#include <vector>

#include "sim/dynamics/system.hpp"

namespace beamcam::sim {

struct InitialState {
    std::vector<double> y;  // System::size numbers
    Phase phase;
    // A resting beam starts from the equilibrium without inertia, because the cam is too fast.
    bool left_behind = false;
    bool unstable = false;                         // the static equilibrium: the beam has buckled under its weight
    std::optional<InitialContact> continued = {};  // the contact that it continues
};

// Throws StepFailure if no equilibrium is found.
InitialState initial_state(const Problem& problem);
InitialState initial_state(const System& system);  // copies the system

// The `initial` of a problem that starts in the state y, which the system has at `t` [s], without contact.
Initial initial_of(const System& system, const std::vector<double>& y, double t = 0);

// The problem that continues the motion of `system`, in its present phase, from the state y at `t` [s]: its time 0. It
// does not know the collision of an approach floor `first-touch`.
Problem continued(const System& system, double t, const std::vector<double>& y);

}  // namespace beamcam::sim
