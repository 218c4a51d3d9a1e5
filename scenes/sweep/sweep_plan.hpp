// The plan of a sweep: points, seconds, bytes.
#pragma once

#include <string>
#include <vector>

#include "scenes/sweep/sweep_grid.hpp"

namespace beamcam::scenes {

struct PlannedFile {
    std::string file, content;
};

// As text or JSON. `files`: the planned files. Simulates a few short motions to estimate the cost.
std::string sweep_plan(const SweepGrid& grid, const std::vector<PlannedFile>& files, int threads, bool json);

}  // namespace beamcam::scenes
