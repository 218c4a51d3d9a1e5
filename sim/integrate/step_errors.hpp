// Error estimates of a collocation step from its nodal values, and the convergence of its iteration. MODEL.md §12.
#pragma once

#include "sim/integrate/collocation.hpp"

namespace beamcam::sim {

// Steps in contact are kept to a share of the tolerance: impacts multiply errors, and at order sixteen it costs little.
inline constexpr double kContactShare = 64;
inline constexpr double kShareOfIteration = 0.02;  // of the tolerance, for the rest of the iteration
inline constexpr double kStalled = 0.9;

// The decay of the Legendre coefficients of nodal values: the larger of the last two, and its ratio to the larger of
// the two before (at most 1).
struct LegendreDecay {
    double last, ratio;
};
LegendreDecay legendre_decay(const Lanes& nodal, double rounding = 0);
// The polynomial through nodal values lies within mean ± spread, and its derivative, times the length of the step,
// within ± slope: sums over its Legendre coefficients, |P_j| <= 1 and |P_j′| <= j(j + 1)/h.
struct LegendreRange {
    double mean, spread, slope;
};
LegendreRange legendre_range(const Lanes& nodal);
// Interpolation error of a forcing with these nodal values. Decaying coefficients show a resolved forcing, whose error
// the integration smooths as well; coefficients that do not decay are aliased vibration, and count in full.
double interpolation_error(const Lanes& nodal);
// Error of the impulse of a nodal force: where coefficients decay by r from pair to pair, the quadrature of order
// sixteen errs by the last times r⁴; where the force starts like a power of time, that power decays. Last coefficients
// below `rounding` are no error.
double quadrature_error(const Lanes& nodal, double rounding = 0);

// Convergence of a fixed-point iteration by its changes, in units of the tolerance.
class FixedPoint {
  public:
    enum class Status { going, settled, failed };
    // Fails once changes grow by more than `growth` after `patience` sweeps, unless they are below `rounding` times the
    // largest or negligible.
    FixedPoint(double rounding, double growth, int patience)
        : rounding_(rounding), growth_(growth), patience_(patience) {}
    // Continues, while changes still contract, until the rest is below this share of the tolerance for a contraction by
    // `contraction` at best, whatever the last two changes show.
    void demand(double share, double contraction) {
        share_ = share;
        contraction_ = contraction;
    }
    Status add(double change);
    bool enough() const { return enough_; }  // changes were once below the tolerance

  private:
    double rounding_, growth_, before_ = 0, largest_ = 0;
    double share_ = kShareOfIteration, contraction_ = 0;
    bool enough_ = false;
    int patience_, sweeps_ = 0;
};

}  // namespace beamcam::sim
