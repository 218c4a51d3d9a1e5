// Warnings of a finished run about its own accuracy and validity, in the terms of the scene.
#pragma once

#include <string>
#include <vector>

#include "sim/observe/request.hpp"
#include "sim/observe/run_statistics.hpp"

namespace beamcam::sim {

// The beam bends through larger angles than its model allows. `largest_elastic`: the largest bending energy of the run
// [J].
bool bends_beyond(const Problem& problem, double largest_elastic);

std::vector<std::string> warnings(const Problem& problem, const Result& result, const RunStatistics& statistics,
                                  double largest_elastic);

// Adds a warning for each table at a rate whose rows miss impacts, or their largest force.
void warn_of_missed_peaks(const Request& request, Result& result);

}  // namespace beamcam::sim
