// Warnings of a finished run about its own accuracy and validity, in the terms of the scene.
#pragma once

#include <string>
#include <vector>

#include "sim/observe/run_statistics.hpp"

namespace beamcam::sim {

// The beam bends through larger angles than its model allows. `largest_elastic`: the largest bending energy of the run
// [J].
bool bends_beyond(const Problem& problem, double largest_elastic);

std::vector<std::string> warnings(const Problem& problem, const Result& result, const RunStatistics& statistics,
                                  double largest_elastic);

}  // namespace beamcam::sim
