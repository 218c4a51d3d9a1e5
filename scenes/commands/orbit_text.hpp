// Periodic orbits and their branches as text, as `orbits` prints them.
#pragma once

#include <string>

#include "output/data/orbit_records.hpp"

namespace beamcam::scenes {

std::string to_text(const output::BranchTable& table);

// What to try if a search for orbits of this number of turns, or of any (0), has found none.
std::string nothing_found(const sim::OrbitRequest& request);

}  // namespace beamcam::scenes
