// Evaluates the contact inside an accepted step by a System of its own, so that event location never changes the
// motion; and how many pieces of the step resolve it.
#pragma once

#include <array>
#include <vector>

#include "sim/dynamics/constants.hpp"
#include "sim/dynamics/system.hpp"
#include "sim/integrate/gap_probe.hpp"
#include "sim/integrate/integrator.hpp"
#include "sim/run/constants.hpp"

namespace beamcam::sim {

class SegmentProbe {
  public:
    explicit SegmentProbe(const System& of) : system(of), gap_(system), y_(static_cast<std::size_t>(of.size)) {}

    // The state at t, kept until the next evaluation.
    const double* state(const Segment& segment, double t) {
        segment.value(t, y_.data());
        return y_.data();
    }
    const double* state() const { return y_.data(); }
    // `search`: over the whole beam, else near the last foot.
    ContactState contact(const Segment& segment, double t, bool search) {
        return system.contact(t, state(segment, t), search);
    }
    // In flight: gap, its rate and foot alone.
    ContactState gap(const Segment& segment, double t, bool search) {
        return gap_.evaluate(t, state(segment, t), search);
    }

    ContactState gap_here(double t, bool search) { return gap_.evaluate(t, y_.data(), search); }  // of `state`

    int pieces(const Segment& segment) const;
    // Every coordinate of the segment stays within `spread` of `middle`.
    struct Range {
        std::array<double, kMaxSize> middle, spread;
    };
    Range range(const Segment& segment);
    // A long step may carry the beam through the cam and out again: no piece moves it by more than half a radius.
    int pieces_by_travel(const Segment& segment, const Range& range);
    int limited(double pieces);
    double gap_rounding() const { return kGapRounding * system.problem().beam.length; }

    System system;
    long coarse = 0;  // steps that need more than kMostPieces pieces

  private:
    GapProbe gap_;
    std::vector<double> y_;
};

}  // namespace beamcam::sim
