// The flow map: the state of a motion after a given time as a function of its initial state, with the touches on the
// way. MODEL.md §16a.
#pragma once

#include <vector>

#include "sim/dynamics/initial.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::sim {

struct MotionTouch {
    double t = 0;         // [s]
    double approach = 0;  // −ġ before it [m/s]
    double flight = 0;    // duration of the flight before it [s]
    double x = 0;         // x_c [m]
    double overhang = 0;  // of the foot beyond the tip; negative between root and tip [m]
};

// A state of a motion near the middle of a flight.
struct Pause {
    double t = 0;  // [s]
    InitialState state;
    double flight = 0;  // its duration [s]
};

struct FlowMap {
    InitialState end;  // final state and phase; a new run may start there
    std::vector<MotionTouch> touches;
    std::vector<Pause> pauses;  // in the flights between two touches
    long holds = 0, lifts = 0;  // impacts followed by sustained contact; ends of sustained contact
};

// Both motions have the same numbers of events.
bool same_events(const FlowMap& a, const FlowMap& b);

// From `start` at t = 0, by the problem's method and tolerances. A start in sustained contact is first moved onto the
// cam. Throws SolverError, Interrupted.
FlowMap flow_map(const Problem& problem, const InitialState& start, double duration, const Progress& progress = {});
// The same with tables that exist already; changes the state of `system`.
FlowMap flow_map(System& system, const InitialState& start, double duration, const Progress& progress = {});

// The state after the duration, from `start` at t = 0, by the problem's own method.
InitialState motion_end(const Problem& problem, const InitialState& start, double duration,
                        const Progress& progress = {});

}  // namespace beamcam::sim
