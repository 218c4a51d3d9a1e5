// The plan of a sweep: its keys, points and files.
#pragma once

#include <string>
#include <vector>

#include "scenes/sweep/sweep_grid.hpp"

namespace beamcam::scenes {

struct PlannedFile {
    std::string file, content;
};

// As text or JSON.
std::string sweep_plan(const SweepGrid& grid, const std::vector<PlannedFile>& files, bool json);

}  // namespace beamcam::scenes
