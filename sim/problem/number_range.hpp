// Whether double arithmetic can represent a problem: each number may be valid, and yet their products (mass, inertia,
// frequency, penetration, speeds) overflow, vanish or lose their digits.
#pragma once

#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// The issues of a problem whose single numbers are valid.
std::vector<Issue> number_range_issues(const Problem& problem);

}  // namespace beamcam::sim
