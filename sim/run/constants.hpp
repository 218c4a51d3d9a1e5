// Numerical constants of a run, each with its reason: tolerance, budgets, event location, transitions, reproducibility.
#pragma once

namespace beamcam::sim {

// ---- tolerance ----
// The share of the tolerance for the local errors of `auto`: the sum over many impacts stays within ten times rtol.
inline constexpr double kLocalShare = 1.0 / 3;

// ---- budgets and progress ----
inline constexpr long kStepsPerReport = 16;         // steps between two calls of `progress`
inline constexpr long kEvaluationsPerReport = 256;  // evaluations of the gap between two calls within one step
inline constexpr double kLongStep = 1e3;  // [rad] of the fastest vibration: after such a step `progress` is called
// A run stops early if the projected number of steps exceeds kHopeless × the budget. The projection uses the later half
// of the steps so far, first at kFirstProjection, because chatter may take some thousands of steps. If that half is
// shorter than kSureProjection, which a brief phase can be, the limit grows with the square of the ratio.
inline constexpr long kFirstProjection = 20000;
inline constexpr double kSureProjection = 30000, kHopeless = 100;
// The largest number that a scene may have [length, or rad]. How fast a linear model diverges above its critical
// speed is a question that runs answer, so that a deflection that no beam has does not end them.
inline constexpr double kUnboundedDeflection = 1e30;

// ---- event location ----
// Subintervals of one step: the usual maximum, which resolves polynomials of degree twelve, and the limit at which the
// search costs more than the integration.
inline constexpr int kMaxPieces = 16;
inline constexpr double kPieceLimit = 1e5;
inline constexpr double kLebesgue = 2.6;      // ≥ 1 + (2/π) ln 12, Lebesgue constant of 13 Chebyshev points
inline constexpr long kMaxAdvances = 100000;  // of conservative advancement through one step
inline constexpr long kFirstAdvances = 2000;  // from here on the search stops if kMaxAdvances will not suffice
inline constexpr double kShortestAdvanceShare = 1e-15;  // of the time: rounding
inline constexpr double kWorthwhileAdvance = 1.0 / 32;  // of the step: the least by the distance of the straight beam
inline constexpr int kMaxTouchIterations = 60;          // Newton's method with bisection
inline constexpr double kTouchGap = 1e-16;              // of the cam's radius: rounding
inline constexpr int kMaxOpeningHalvings = 24;  // of the first subinterval, in search of an open gap after a release
inline constexpr double kFootStiffness = 0.5;  // least r″·D + r′·r′ for which the gap's acceleration is bounded
inline constexpr double kRestSpeed = 1e-12;    // [m/s]: smaller speeds are rounding
inline constexpr double kRestAcceleration = 1e-20;  // [m/s²]: smaller ones are rounding, and move nothing in any run
inline constexpr double kGapErrors = 10;            // step tolerances in the gap: several coordinates contribute
inline constexpr double kLowestBounce = 1e-13;      // of the beam's length: a hundred times the gap's rounding error
inline constexpr double kForceDifference = 1e-4;    // of the step: finite difference for Ṅ, where the force is smooth
inline constexpr double kGuardDifference = 1e-2;    // of the step: finite difference for the rate of a guard
inline constexpr double kGuardRounding = 1e-9;      // of a guard's largest value: shallower minima are rounding
inline constexpr double kSameInstant = 1e-9;        // of the subinterval: events at a smaller distance are one
inline constexpr double kVanishingForce = 1e-9;     // of weight and largest force: smaller tensile forces are rounding
inline constexpr double kPredictedShift = 1e-3;     // of the step: largest correction of an event's time
inline constexpr double kInstantRounding = 1e-14;   // of the time: closer instants are one

// ---- transitions ----
// Stick and slip may both be impossible within rounding, and a rebound may be smaller than the error of a step. After
// kMaxInstantEvents events at one instant the friction state is kept for one step, and an impact becomes plastic; after
// kMaxIdleEvents the run stops.
inline constexpr int kMaxInstantEvents = 10, kMaxIdleEvents = 50;
inline constexpr double kPlastic = 1e-9;         // of the approach speed: a slower rebound is rounding
inline constexpr double kFirstTouchStep = 0.05;  // of the time to maximum penetration, so that all stages see the force
inline constexpr double kBounces = 4;            // largest number of bounces within the first step of a flight
// Conditions of summed-up chatter (S57): its duration times the highest frequency, for an error of (10⁻³)²/6 of the
// last rebound; and the relative change of the acceleration towards the cam.
inline constexpr double kBriefChatter = 1e-3, kSteadyPull = 1e-2;

// ---- reproducibility ----
inline constexpr double kReproducible = 1e-6;       // [rad], or relative to angles above 1 rad
inline constexpr double kComparedRate = 1000;       // [Hz] sampling rate of the comparison
inline constexpr double kBriefAgreement = 0.1;      // [s] a shorter agreement of two motions is a crossing
inline constexpr double kTighterTolerance = 1e-2;   // of the tolerance: that of the comparison
inline constexpr double kTightestRtol = 1e-13;      // below it rounding errors dominate
inline constexpr double kMaxComparedSteps = 500e3;  // of an explicit method: some seconds
inline constexpr double kExplicitRadians = 2;       // of the fastest vibration in one step of such a method

}  // namespace beamcam::sim
