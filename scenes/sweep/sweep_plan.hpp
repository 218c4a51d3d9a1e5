// What a sweep would do: points, seconds, bytes.
#pragma once

#include <string>
#include <vector>

#include "scenes/sweep/sweep_grid.hpp"

namespace beamcam::scenes {

struct PlannedFile {
    std::string file, content;
};

// `files`: what it would write. A few lines for people, or an object for programs. Follows a few short motions to know
// what they cost.
std::string sweep_plan(const SweepGrid& grid, const std::vector<PlannedFile>& files, int threads, bool json);

}  // namespace beamcam::scenes
