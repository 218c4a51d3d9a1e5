// Agreement of a computed motion with measured or other data of one channel, at the instants of the data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/observe/channels.hpp"
#include "sim/observe/result.hpp"

namespace beamcam::output {

struct Agreement {
    std::string label, file;
    sim::Channel channel;
    // Differences, measured minus computed, while θ is reproducible.
    struct Part {
        std::size_t rows = 0;
        double rms = 0, largest = 0, t_largest = 0;
        double highest = 0;  // largest measured value minus largest computed value
    };
    Part whole;
    struct AfterCollision : Part {
        int collision = 0;  // number from 1; the part ends at the next collision
        double t_start = 0;
    };
    std::vector<AfterCollision> collisions;  // those with rows
    // While θ is not reproducible: statistics of both.
    struct Statistics {
        double mean = 0, deviation = 0;
    };
    struct Beyond {
        std::size_t rows = 0;
        Statistics measured, computed;
    };
    std::optional<Beyond> beyond;
};

// Skips rows with a missing value. `times` must increase; `result` must have a horizon.
Agreement agreement(const std::vector<double>& times, const std::vector<double>& measured,
                    const std::vector<double>& computed, const sim::Result& result);

}  // namespace beamcam::output
