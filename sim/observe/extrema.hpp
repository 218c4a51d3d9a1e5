// Where channels are largest and smallest: the best samples of each step (StepSamples), refined on its dense output.
// MODEL.md §12, (S59).
#pragma once

#include <span>

#include "sim/observe/result.hpp"
#include "sim/observe/step_samples.hpp"

namespace beamcam::sim {

// Raises the maxima and lowers the minima, one of each a channel, to those within the step.
void raise_extrema(StepSamples& step, const SegmentInterval& s, std::span<const Channel> channels,
                   std::span<Extremum> extrema);
// Raises the impact's largest normal force and penetration to those within the step.
void raise_peaks(StepSamples& step, const SegmentInterval& s, Impact& impact);

}  // namespace beamcam::sim
