// Numerical constants of sweeps, each with its reason: classification of motions, closed forms of the rigid beam.
#pragma once

#include <cstddef>

namespace beamcam::sim {

// ---- classification ----
// States are compared at this share of a turn of the cam after the start. It is not zero, because a motion that starts
// on its orbit may have an impact there, at which the rate jumps.
inline constexpr double kStrobePhase = 0.381966;
inline constexpr double kSameState = 1e-5;          // of the cam's lift and its rate: closer states are equal
inline constexpr double kUsualLift = 1e-3;          // [rad] in place of a lift of zero
inline constexpr int kPeriodRepeats = 3;            // least number of repetitions of a period in the compared turns
inline constexpr std::size_t kFewestTurns = 12;     // least number of turns for the classes without a period
inline constexpr double kDifferenceNoise = 1e-7;    // of the lift: smaller changes of a difference are ignored
inline constexpr double kSettledShare = 0.1;        // of a difference: largest distance of its extrapolated limit
inline constexpr double kVanishingMismatch = 0.02;  // of the lift: a smaller distance from a period may still vanish
inline constexpr double kSettledTolerances = 10;    // error of a settled motion, in units of rtol
inline constexpr int kCarriedRounds = 8;            // Newton iterations that move a carried state to the surface
inline constexpr double kWholeTurn = 1e-12;         // of the number of turns: rounding of a time in turns

// ---- the rigid beam between impacts ----
inline constexpr int kSurfacePlaces = 128;       // around the turn, to begin with: then halved where bounds ask for it
inline constexpr double kSurfaceMargin = 0.005;  // of the range of θ̈_c, by which its bounds may exceed its extrema
inline constexpr int kMostSurfaceHalvings = 30;  // of the distance of two places, to rounding
inline constexpr double kInsideBeam =
    1e-3;  // of the length: least distance of the contact from the beam's ends and the axis
inline constexpr double kRigidAccuracy = 1e-13;    // [rad] error of a settled motion: some hundred rounding errors
inline constexpr double kOpeningDepth = 1e-13;     // [rad] below the surface while the gap opens: rounding
inline constexpr double kAngleRounding = 2e-16;    // [rad] rounding of an angle; limit of the last terms of its series
inline constexpr double kShortestAdvance = 1e-15;  // [s]
inline constexpr double kTouchInstant = 1e-16;     // of the cam's turn: rounding of the touch's instant
inline constexpr int kMaxSurfaceIterations = 60;   // Newton's method with bisection
inline constexpr double kFarFromAway = 1.5;        // [rad] from the cam's axis: a little less than π/2
inline constexpr long kPlacesPerReport = 16384;    // comparisons with the surface between two calls of `progress`
inline constexpr double kSeriesReach = 0.9;        // of the length that the last terms of the series allow
inline constexpr double kLongestTurn = 1;          // [rad] of a series without gravity, which is a polynomial

}  // namespace beamcam::sim
