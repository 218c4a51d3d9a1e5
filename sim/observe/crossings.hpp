// Where a channel passes a level within a step: zero crossings of θ, its maxima (apexes), and sections. All of them are
// found, however close together, by bounds of how far the channel varies between samples. MODEL.md §12, (S59).
#pragma once

#include <vector>

#include "sim/observe/step_channels.hpp"

namespace beamcam::sim {

struct LevelCrossing {
    double t;
    bool rises;
};

// Each appends to `found` in the order of time.
void find_apexes(StepChannels& step, const SegmentInterval& s, std::vector<Apex>& found);
void find_zero_crossings(StepChannels& step, const SegmentInterval& s, std::vector<ZeroCrossing>& found);
void find_crossings(StepChannels& step, const SegmentInterval& s, Channel channel, double level,
                    std::vector<LevelCrossing>& found);

}  // namespace beamcam::sim
