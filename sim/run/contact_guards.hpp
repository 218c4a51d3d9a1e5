// Locates the first event in a step in contact: release, start or end of the force's clamp, stick–slip transition; in
// sustained impulsive contact the lift. MODEL.md (S36), (S58).
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
    // The instant at which the constraint force of sustained contact becomes tensile.
    Event first_lift(const Segment& segment);
    // The instant at which the contact passes a jump of the cam's radius of curvature or its derivative.
    std::optional<double> first_kink(const Segment& segment);

  private:
    // The guard functions at one instant.
    struct Guards {
        double side;          // ContactState::side
        Guard release;        // penetration and its rate
        double clamp = 1;     // 1 + D δ̇/δ̇₋; the force has a kink where it changes sign
        double friction = 1;  // positive while the state of friction lasts (S36)
    };
    Guards evaluate(const Segment& segment, double t);
    // Throws if the disc's centre has changed sides since the touch.
    void check_side(const Guards& now);
    double force_growth(const Segment& segment, double t);
    std::optional<double> clamp_event(const Segment& segment, const Guards& a, const Guards& b);
    bool may_change_friction();

    SegmentProbe& probe_;
    RunState& state_;
    std::vector<double> friction_;  // Guards::friction at the instants of one step
};

}  // namespace beamcam::sim
