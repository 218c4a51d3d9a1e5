// Counts of an integration: its work, and the places where it departed from the request.
#pragma once

#include "sim/observe/result.hpp"

namespace beamcam::sim {

// Departures from the request, and events that could not be resolved.
struct Fallbacks {
    long steps = 0;             // by `method` instead of the exponential collocation
    long friction_changes = 0;  // steps in which stick and slip alternate at one instant, and neither was changed
    long strikes = 0;           // taken as plastic because the rebound is below the error of the step
    long coarse = 0;            // steps whose vibration is faster than the touch search resolves
    long left_behind = 0;       // starts at rest on a turning cam where no motion along with it was found
    long unstable = 0;          // static starts of a beam that has buckled
    double gap = 0;             // largest magnitude of the gap at an event, subtracted from there on [m]
    Method method = Method::rk8;
};

// Counts so far.
struct RunStatistics {
    Counters counters;
    Method method = Method::automatic;  // of all steps but those of a fallback
    long floored = 0;                   // touches slower than the approach floor
    long chatters = 0;                  // ends of chatter in sustained contact
    Fallbacks fallbacks;
};

}  // namespace beamcam::sim
