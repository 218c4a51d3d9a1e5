// Low bounces of impulsive contact: when they count as one impact with sustained contact afterwards. MODEL.md §12,
// (S57).
#pragma once

#include <cmath>

#include "sim/observe/constants.hpp"
#include "sim/problem/problem.hpp"
#include "sim/run/constants.hpp"

namespace beamcam::sim {

// Normal speeds before and after an impact [m/s].
struct Bounce {
    double approach, rebound;

    // Slow enough that all further bounces may be summed up.
    bool is_summable(const Contact& contact) const {
        return rebound > kPlastic * approach && rebound < approach &&
               rebound < kSummedShare * contact.approach_floor.value;
    }
    // The time until they end under a constant acceleration towards the cam.
    double chatter_time(double pull) const { return 2 * rebound / (pull * (1 - rebound / approach)); }
    // They end: they are slow, or rounding of the gap keeps low ones from becoming lower.
    bool ends_chatter(double pull, double last_rebound, const Problem& problem) const {
        const bool low = pull > 0 && rebound * rebound < 2 * pull * kLowestBounce * problem.beam.length;
        return rebound < kChatterShare * problem.contact.approach_floor.value || (low && rebound >= last_rebound);
    }
};

// The acceleration towards the cam is the same at both ends of the bounces.
inline bool is_steady(double pull, double later) { return std::fabs(later - pull) < kSteadyPull * pull; }

}  // namespace beamcam::sim
