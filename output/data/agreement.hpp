// Agreement of a computed motion with measured or other data of one channel, at the instants of the data.
#pragma once

#include <string>
#include <vector>

#include "sim/observe/channels.hpp"
#include "sim/observe/result.hpp"

namespace beamcam::output {

struct Agreement {
    std::string label, file;
    sim::Channel channel;
    // Differences, measured minus computed, where both have a value and θ is reproducible.
    std::size_t rows = 0;
    double rms = 0;
};

// `times` must increase; `result` must have a horizon.
Agreement agreement(const std::vector<double>& times, const std::vector<double>& measured,
                    const std::vector<double>& computed, const sim::Result& result);

}  // namespace beamcam::output
