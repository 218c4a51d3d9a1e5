// Where a channel passes a level within a step: zero crossings of θ, its maxima (apexes), and sections. The channel is
// sampled as for extrema; two crossings between neighbouring samples are found by the parabola through them.
// MODEL.md §12, (S59).
#pragma once

#include <vector>

#include "sim/observe/result.hpp"
#include "sim/observe/step_samples.hpp"

namespace beamcam::sim {

struct LevelCrossing {
    double t;
    bool rises;
};

// Each appends to `found` in the order of time.
void find_apexes(StepSamples& step, const SegmentInterval& s, std::vector<Apex>& found);
void find_zero_crossings(StepSamples& step, const SegmentInterval& s, std::vector<ZeroCrossing>& found);
void find_crossings(StepSamples& step, const SegmentInterval& s, Channel channel, double level,
                    std::vector<LevelCrossing>& found);

}  // namespace beamcam::sim
