// Numerical constants of sweeps, each with its reason: what a motion settles to, and the rigid beam's closed forms.
#pragma once

#include <cstddef>

namespace beamcam::sim {

// ---- what a motion settles to ----
inline constexpr double kSameState = 1e-5;        // of the cam's lift and of its rate: states closer than this are one
inline constexpr double kUsualLift = 1e-3;        // [rad] where the cam does not lift the beam
inline constexpr int kPeriodRepeats = 3;          // a period must fit so often into the turns that are compared
inline constexpr std::size_t kFewestTurns = 12;   // in which a motion without a period is told from one that settles
inline constexpr double kDifferenceNoise = 1e-7;  // of the lift: changes of a difference that mean nothing
inline constexpr double kSettledShare = 0.1;      // of a difference: its limit is no farther
inline constexpr double kVanishingMismatch = 0.02;  // of the lift: differences from a period that may still vanish
inline constexpr std::size_t kExponentBlocks = 10;  // of the exponent
inline constexpr double kSureErrors = 3;            // standard errors
inline constexpr double kSmallError = 0.02;         // per turn, of an exponent that is zero
// In the later half: differences that grow like the time double, ln 2 and some.
inline constexpr double kLinearGrowth = 1.2;
inline constexpr double kSettledTolerances = 10;  // of the tolerance: errors of a settled motion
inline constexpr long kLaterTurns = 1000;         // in which a chaotic motion may settle: milliseconds by closed forms

// ---- the rigid beam between impacts ----
inline constexpr int kSurfacePlaces = 720;       // around the turn: a few for each degree of what e < R can bend
inline constexpr double kLiftMargin = 0.01;      // of the range of θ̈_c, for what lies between two places
inline constexpr double kInsideBeam = 1e-3;      // of the length: the contact keeps this distance from the beam's ends
inline constexpr double kRigidAccuracy = 1e-13;  // [rad] of a settled motion: some hundred roundings
inline constexpr double kOpeningDepth = 1e-13;   // [rad] below the surface while it opens: rounding
inline constexpr double kAngleRounding = 2e-16;  // [rad] of an angle, and of the last terms of its series
inline constexpr double kShortestAdvance = 1e-15;  // [s]
inline constexpr double kTouchInstant = 1e-16;     // of the cam's turn: the touch is known no better
// Turns before the samples in which the difference turns into the direction that grows most.
inline constexpr long kWarmUp = 20;
inline constexpr double kFarFromAway = 1.5;         // [rad] from the cam's axis; a little less than π/2
inline constexpr long kStretchesPerReport = 4096;   // between two calls of `progress`
inline constexpr double kLargestDifference = 1e50;  // and the smallest is its inverse: far from overflow
inline constexpr double kSeriesReach = 0.9;         // of the length of a stretch that the last terms allow
inline constexpr double kLongestTurn = 1;           // [rad] of a stretch without gravity, whose series ends by itself

}  // namespace beamcam::sim
