// What the table of a sweep gives to the search of periodic orbits: impacts to stand beneath branches, and the state of
// a row to begin in.
#pragma once

#include <string>

#include "scenes/figures/branches.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::scenes {

// The impacts of a .csv, .npz or .nc table of `sweep --sample impacts` where the key lies between two values. Throws
// UsageError where a column is missing.
SweptImpacts swept_impacts(const std::string& file, const std::string& key, double from, double to);

// The problem in the state of a row (1, 2, …) of a sweep's table: the values of its keys, the cam's angle, θ and θ̇.
// What else the beam has, its vibration, a transient brings. Throws UsageError, SceneError.
sim::Problem problem_at_row(sim::Problem problem, const std::string& file, int row);

}  // namespace beamcam::scenes
