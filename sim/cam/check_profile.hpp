// The rules that a cam's profile must obey: a closed convex outline about the axis, and a law that a lever can follow.
#pragma once

#include <string>
#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// The errors and warnings of the profile, with their keys; `problem` has a cam with a profile, and its numbers are in
// their ranges. Without errors CamShape may be constructed.
std::vector<Issue> check_profile(const Problem& problem);

// The remedy for points that reach beyond the hub, whose unit may be missing; else empty.
std::string hint_of_unit(const Problem& problem);

}  // namespace beamcam::sim
