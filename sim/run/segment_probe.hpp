// Evaluates the contact inside an accepted step with the System of the run, whose right-hand side sets its own state.
// Also determines how many subintervals resolve the step.
#pragma once

#include <array>
#include <vector>

#include "sim/base/numerics.hpp"
#include "sim/dynamics/system.hpp"
#include "sim/integrate/gap_probe.hpp"
#include "sim/integrate/integrator.hpp"

namespace beamcam::sim {

// Subintervals of one step: the usual maximum, which resolves polynomials of degree twelve, and the limit at which the
// search costs more than the integration.
inline constexpr int kMaxPieces = 16;
inline constexpr double kPieceLimit = 1e5;

class SegmentProbe {
  public:
    explicit SegmentProbe(System& of) : system(of), gap_(system), y_(static_cast<std::size_t>(of.size)) {}

    // The state at t; valid until the next evaluation.
    const double* state(const Segment& segment, double t) {
        segment.value(t, y_.data());
        return y_.data();
    }
    const double* state() const { return y_.data(); }
    ContactState contact(const Segment& segment, double t) { return system.contact(t, state(segment, t)); }
    // The same to rounding at less cost, but for `at_end` and `side`.
    ContactState gap(const Segment& segment, double t) { return gap_.evaluate(t, state(segment, t)); }

    int pieces(const Segment& segment) const;
    // Bounds of the coordinates in a segment: middle ± spread.
    struct Range {
        std::array<double, kMaxSize> middle, spread;
    };
    Range range(const Segment& segment);
    // Subintervals in which the beam moves by at most half the radius of a disc within the cam, so that it cannot pass
    // the cam unnoticed, and in which an eccentric cam turns by at most a radian.
    int pieces_by_travel(const Segment& segment, const Range& range);
    int limited(double pieces);
    double gap_rounding() const { return kRounding * system.problem().beam.length; }

    System& system;
    long coarse = 0;  // steps that need more than kPieceLimit subintervals

  private:
    GapProbe gap_;
    std::vector<double> y_;
};

}  // namespace beamcam::sim
