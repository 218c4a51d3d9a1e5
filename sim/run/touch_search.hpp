// Locates the first touch in a step of flight. MODEL.md (S56), (S58).
#pragma once

#include <functional>
#include <optional>

#include "sim/integrate/event_search.hpp"
#include "sim/run/advancement.hpp"
#include "sim/run/run_state.hpp"
#include "sim/run/segment_probe.hpp"

namespace beamcam::sim {

class TouchSearch {
  public:
    // `report` is called during long searches, with the time reached.
    TouchSearch(SegmentProbe& probe, const RunState& state, std::function<void(double)> report)
        : probe_(probe), state_(state), report_(std::move(report)) {}
    std::optional<double> first_touch(const Segment& segment);

  private:
    std::optional<double> by_pieces(const Segment& segment, double end, int count);
    std::optional<double> by_advancement(const Segment& segment, const MotionBounds& bounds);
    std::optional<double> advance(const Segment& segment, double t, ContactState c, const Advancement& gap);
    std::optional<double> by_resolving(const Segment& segment);
    bool opens(const Segment& segment, double t);
    double step_error() const;
    double gap_acceleration_bound(const MotionBounds& bounds, double far) const;
    double reach() const { return std::fabs(problem().hub.radius) + problem().beam.length; }
    double lower_bound(double t, double h, const double* xi, const double* spread) const;
    const Problem& problem() const { return probe_.system.problem(); }
    const TurningCam& cam() const { return probe_.system.cam(); }

    SegmentProbe& probe_;
    const RunState& state_;
    std::function<void(double)> report_;
};

}  // namespace beamcam::sim
