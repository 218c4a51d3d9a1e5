// What an integration has counted: its work, and what it did in another way than asked for.
#pragma once

#include "sim/observe/result.hpp"

namespace beamcam::sim {

// What an integration did in another way than asked for, or could not resolve.
struct Fallbacks {
    long steps = 0;             // by `method` instead of the exponential collocation
    long handed_over = 0;       // contacts that the collocation could not solve
    long friction_changes = 0;  // steps in which a bristle's grip stayed though it breaks and catches at one instant
    long strikes = 0;           // taken as plastic because the step's error swallows the rebound
    long coarse = 0;            // steps whose vibration is faster than the looks for a touch resolve
    long left_behind = 0;       // resting starts on a turning cam without a motion along it
    long searches = 0;          // for an extremum that ended before they were sure
    double gap = 0;             // largest distance from zero of the gap at an event, taken out of it from there on [m]
    Method method = Method::rk8;
};

// What an integration has counted so far.
struct RunStatistics {
    Counters counters;
    long floored = 0;   // touches slower than the approach floor
    long chatters = 0;  // ends of chatter in sustained contact
    Fallbacks fallbacks;
};

}  // namespace beamcam::sim
