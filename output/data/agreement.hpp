// How a computed motion agrees with measured or foreign data of one channel, at the instants of the data.
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
    // Differences, measured minus computed, where θ is reproducible.
    struct Part {
        std::size_t rows = 0;
        double rms = 0, largest = 0, t_largest = 0;
        double highest = 0;  // the largest measured value less the largest computed one
    };
    Part whole;
    struct AfterCollision : Part {
        int collision = 0;  // from 1; until the next one
        double t_start = 0;
    };
    std::vector<AfterCollision> collisions;  // those with rows
    // Where it is not, single values mean nothing: statistics of both.
    struct Statistics {
        double mean = 0, deviation = 0;
    };
    struct Beyond {
        std::size_t rows = 0;
        Statistics measured, computed;
    };
    std::optional<Beyond> beyond;
};

bool is_reproducible(const sim::Result& result, double t);

// Rows in which a value is missing are left out. `times` increase; `result` has a horizon.
Agreement agreement(const std::vector<double>& times, const std::vector<double>& measured,
                    const std::vector<double>& computed, const sim::Result& result);

}  // namespace beamcam::output
