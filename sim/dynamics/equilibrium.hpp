// Equilibria from which a motion starts: of the beam with its hub held at an angle, and of the beam on the cam at rest
// or turning. MODEL.md §11.
#pragma once

#include <Eigen/Core>

#include "sim/dynamics/system.hpp"

namespace beamcam::sim {

struct HeldBeam {
    Eigen::VectorXd xi;
    bool unstable = false;  // it has buckled under its weight
};
// Both throw StepFailure if there is no equilibrium.
HeldBeam held_beam(const System& system, double angle);

// One instant of a motion in which the beam follows the cam.
struct FollowingState {
    Eigen::VectorXd xi, rate, acceleration;
    bool pressed = true;  // N >= 0: the cam need not pull
};

struct RestingBeam {
    FollowingState start;
    bool left_behind = false;  // the equilibrium without inertia, because the cam is too fast to be followed
};
RestingBeam resting_beam(const System& system);

}  // namespace beamcam::sim
