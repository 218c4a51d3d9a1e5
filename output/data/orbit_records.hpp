// Periodic orbits, their branches and Lyapunov exponents as files, with the names scripts rely on.
#pragma once

#include <string>
#include <vector>

#include "output/data/column_table.hpp"
#include "sim/orbit/continuation.hpp"
#include "sim/orbit/exponents.hpp"

namespace beamcam::output {

// Exponents with their errors, and their convergence; null where one is −∞, and "chaotic" where that is doubtful.
std::string exponents_json(const sim::Exponents& exponents);

// Periodic orbits of a scene, and the branches that were followed from one of them.
struct BranchTable {
    std::string key, unit;  // of the scene, over which the branches go; empty: none were
    double start = 0;       // its value for `orbits`
    std::vector<sim::PeriodicOrbit> orbits;
    std::vector<sim::Branch> branches;
};
// {"parameter", "start", "orbits": […], "branches": [{"period", "impacts", "points": […]}], "events": […]}. A period is
// counted in turns of the cam, as in sweeps.
std::string orbits_json(const BranchTable& table);
// A row for each impact of each point of the branches; without branches, of the orbits. `attributes` are a NetCDF
// file's.
ColumnTable orbit_columns(const BranchTable& table, std::vector<std::pair<std::string, std::string>> attributes);

}  // namespace beamcam::output
