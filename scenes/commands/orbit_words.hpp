// Periodic orbits and their branches in words, as `orbits` prints them.
#pragma once

#include <string>

#include "output/data/orbit_records.hpp"

namespace beamcam::scenes {

std::string orbits_in_words(const output::BranchTable& table);

}  // namespace beamcam::scenes
