// What a finished run has to say of its own numbers, in the user's terms.
#pragma once

#include <string>
#include <vector>

#include "sim/observe/run_statistics.hpp"

namespace beamcam::sim {

// Model `restitution`: bounces slower than this share of the approach floor are summed up in closed form where
// nothing but they changes meanwhile (MODEL.md (S57)).
inline constexpr double kSummedShare = 0.1;
// Elsewhere a rebound slower than this share ends the chatter in sustained contact. A bouncing point then rests at
// most 2v/(g(1 − e)) too early (MODEL.md §9).
inline constexpr double kChatterShare = 1e-3;

// Through angles that the model does not hold for. `largest_elastic`: the largest bending energy of the run [J].
bool bends_beyond(const Problem& problem, double largest_elastic);

std::vector<std::string> warnings(const Problem& problem, const Result& result, const RunStatistics& statistics,
                                  double largest_elastic);

}  // namespace beamcam::sim
