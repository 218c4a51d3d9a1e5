// Periodic orbits, their branches and Lyapunov exponents as JSON, with the names that scripts use.
#pragma once

#include <string>
#include <vector>

#include "sim/orbit/continuation.hpp"
#include "sim/orbit/exponents.hpp"

namespace beamcam::output {

// Exponents, their errors and their convergence. An exponent of −∞ is null; "chaotic" is null if it is doubtful.
std::string exponents_json(const sim::Exponents& exponents);

// Periodic orbits of a scene, and the branches that start from them.
struct BranchTable {
    std::string key, unit;    // the varied key of the scene; empty: no branches
    double start = 0;         // its value for `orbits`
    double from = 0, to = 0;  // its range for `branches`
    std::vector<sim::PeriodicOrbit> orbits;
    std::vector<sim::Branch> branches;
};
// {"parameter", "start", "orbits": […], "branches": [{"period", "impacts", "points": […]}], "events": […]}. Periods are
// in turns of the cam, as in sweeps.
std::string orbits_json(const BranchTable& table);

}  // namespace beamcam::output
