// The state of a run, shared by event location and transitions.
#pragma once

#include <optional>
#include <vector>

#include "sim/dynamics/system.hpp"
#include "sim/observe/observer.hpp"
#include "sim/observe/run_statistics.hpp"

namespace beamcam::sim {

// Stick and slip may both be impossible within rounding, and a rebound may be smaller than the error of a step. After
// so many events at one instant the friction state is kept for one step, and an impact becomes plastic.
inline constexpr int kMaxInstantEvents = 10;

enum class EventKind { none, touch, release, clamp, friction, lift, kink };

struct Event {
    EventKind kind = EventKind::none;
    double t = 0;
};

struct RunState {
    double t = 0;
    std::vector<double> y;
    Phase phase;
    double phase_start = 0;
    double clamp_side = 1;              // +1: the force is positive, −1: it is clamped
    double side = 0;                    // of the beam on which the cam touches (ContactState::side); 0: not yet known
    int idle_events = 0;                // consecutive events at this instant
    std::optional<double> chatter_end;  // of summed-up chatter (S57) [s]
    RunStatistics statistics;           // without the counters of the integrator
    std::vector<Observer*> observers;
};

}  // namespace beamcam::sim
