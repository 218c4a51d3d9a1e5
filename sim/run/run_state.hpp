// The state of a run that event location and transitions share.
#pragma once

#include <optional>
#include <vector>

#include "sim/dynamics/system.hpp"
#include "sim/observe/recorder_set.hpp"

namespace beamcam::sim {

enum class EventKind { none, touch, release, clamp, grip, lift };

struct Event {
    EventKind kind = EventKind::none;
    double t = 0;
};

struct RunState {
    double t = 0;
    std::vector<double> y;
    Phase phase;
    double phase_start = 0;
    double clamp_side = 1;              // of the kink of the clamp where it was last away from it: +1 pushes
    double side = 0;                    // of the beam on which the cam touches, once a look has shown it
    int idle_events = 0;                // at this instant, without time passing
    std::optional<double> chatter_end;  // of the chatter that was summed up
    RunStatistics statistics;           // without the integrator's counters
};

}  // namespace beamcam::sim
