// Validation of a problem without a simulation: all errors and warnings at once.
#pragma once

#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// Values outside the ranges of problem.hpp, impossible combinations (cam over the hub, overlap at the start, e >= R,
// hub-beam basis with a prescribed drive, …), and warnings such as a cam that the beam cannot reach.
std::vector<Issue> validate(const Problem& problem);
// Throws std::invalid_argument with the first fatal issue.
void require_valid(const Problem& problem);

}  // namespace beamcam::sim
