// What a finished run has to say of its own numbers, in the user's terms.
#pragma once

#include <string>
#include <vector>

#include "sim/observe/run_statistics.hpp"

namespace beamcam::sim {

// Through angles that the model does not hold for. `largest_elastic`: the largest bending energy of the run [J].
bool bends_beyond(const Problem& problem, double largest_elastic);

std::vector<std::string> warnings(const Problem& problem, const Result& result, const RunStatistics& statistics,
                                  double largest_elastic);

}  // namespace beamcam::sim
