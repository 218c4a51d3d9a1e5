// The first event in a step in contact: release, clamp of the force, change of the grip; lift of sustained contact.
// MODEL.md (S36), (S58).
#pragma once

#include <optional>
#include <vector>

#include "sim/integrate/event_search.hpp"
#include "sim/run/run_state.hpp"
#include "sim/run/segment_probe.hpp"

namespace beamcam::sim {

class ContactGuards {
  public:
    ContactGuards(SegmentProbe& probe, RunState& state) : probe_(probe), state_(state) {}
    Event first_event(const Segment& segment);
    // Held on the cam until the force that holds it would have to pull.
    Event first_lift(const Segment& segment);

  private:
    // The guards of contact at one instant.
    struct Guards {
        double side;       // of the beam (ContactState)
        Guard release;     // penetration and its rate
        double clamp = 1;  // 1 + D δ̇/δ̇₋: where it changes sign the never-negative force has a kink
        double grip = 1;   // positive while the grip holds (S36)
    };
    Guards evaluate(const Segment& segment, double t);
    // Throws when the disc's centre has changed sides since the touch.
    void check_side(const Guards& now);
    double sliding_guard(const Segment& segment, double t, double slip);
    std::optional<double> clamp_event(const Segment& segment, const Guards& a, const Guards& b);
    bool may_change_grip();

    SegmentProbe& probe_;
    RunState& state_;
    std::vector<double> grip_;  // the guard at the instants of one step
};

}  // namespace beamcam::sim
