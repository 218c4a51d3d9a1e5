// Periodic orbits and their branches as text, as `orbits` prints them.
#pragma once

#include <string>

#include "output/data/orbit_records.hpp"

namespace beamcam::scenes {

std::string to_text(const output::BranchTable& table);

// What was searched in vain, and what to try.
std::string nothing_found(const sim::OrbitRequest& request);

}  // namespace beamcam::scenes
