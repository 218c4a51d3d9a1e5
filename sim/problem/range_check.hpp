// Checks each number of a problem against the range of its key.
#pragma once

#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

void check_ranges(const Problem& problem, std::vector<Issue>& out);

}  // namespace beamcam::sim
