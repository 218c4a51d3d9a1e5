// The search of periodic orbits takes these from keys of a scene and from the table of a sweep: the problem at a value,
// impacts to plot, and an initial state.
#pragma once

#include <string>

#include "scenes/figures/command_figures.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::scenes {

// The problem with another value of a key. Throws SceneError for an impossible one; with `any_start` its initial state
// may be.
sim::Problem problem_with(sim::Problem problem, const std::string& key, double value, bool any_start = false);

// The impacts in a .csv or .npz table of `sweep --sample impacts` with the key between two values. Throws
// UsageError for a missing column.
SweptImpacts swept_impacts(const std::string& file, const std::string& key, double from, double to);

// The problem in the state of row 1, 2, … of a sweep's table: the values of its keys, the cam's angle, θ and θ̇. The
// state of vibration is not in the table; a transient restores it. Throws UsageError, SceneError.
sim::Problem problem_at_row(sim::Problem problem, const std::string& file, int row);

}  // namespace beamcam::scenes
