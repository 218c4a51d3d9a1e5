// Whether the scales that follow from a problem's numbers (mass, inertia, frequency, speeds, depth of a touch) leave
// its equations within the range and the resolution of double arithmetic. Each number may be sane, and what they make
// not.
#pragma once

#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// What makes the problem one that nothing can be computed of; for a problem whose single numbers are valid.
std::vector<Finding> beyond_arithmetic(const Problem& problem);

}  // namespace beamcam::sim
