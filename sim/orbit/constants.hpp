// Numerical constants of orbits, branches and exponents, each with its reason.
#pragma once

#include <cstddef>

namespace beamcam::sim {

// ---- tangents ----
inline constexpr int kTangentMemories = 2;         // additional rows: z and δ̇₋
inline constexpr double kTangentRounding = 1e-14;  // smallest tolerance of a step: rounding
// Least order of convergence of a step. Step lengths of neighbouring levels differ by √2.
inline constexpr int kTangentOrder = 8;
inline constexpr double kSameLength = 1e-13;    // of a step: rounding of the time
inline constexpr double kSameSpeed = 1e-9;      // relative difference in speed by rounding of the gap at a touch
inline constexpr double kSlowestMotion = 1e-3;  // [1/s] rate of the hub's unit without cam speed and gravity

// ---- the section map and its fixed points ----
inline constexpr double kTightRtol = 1e-12, kTightAtol = 1e-14;  // the limits set by rounding
inline constexpr int kMaxMapSteps = 3'000'000;                   // integration steps of one section map: minutes
inline constexpr int kMaxOrbitNewton = 16;                       // iterations
// Residual over the orbit's size: converged; acceptable if rounding allows no further decrease; hopeless.
inline constexpr double kOrbitConverged = 1e-11, kOrbitAcceptable = 1e-8, kOrbitLost = 1e3;
inline constexpr double kLongestStep = 0.5;  // of the size: largest Newton step
inline constexpr double kReturn = 0.2;       // of the size: distance after some turns at which Newton's method is tried
inline constexpr int kThrows = 24;           // cam angles of throws; as many between them if no orbit is found
inline constexpr double kRise = 0.4;         // of the period: the thrown beam is in flight at this time
inline constexpr double kAboveCam = 1e-6;    // [rad] so that the throw does not start with a touch
inline constexpr double kSameOrbit = 1e-6;   // relative difference of impact speeds: closer orbits are one

// ---- branches ----
inline constexpr int kMaxArcNewton = 8;  // iterations; if a prediction needs more, the step is shortened
// Residual of the corrector over the orbit's size: converged; acceptable if rounding allows no further decrease.
inline constexpr double kArcConverged = 1e-11, kArcAcceptable = 1e-9;
// The finite difference for ∂P/∂p, as a share of the range, affects the tangent and the corrector's convergence.
inline constexpr double kArcDifference = 1e-6;
inline constexpr double kNearFold = 0.1;  // of the unit tangent: its part along the parameter is smaller near a fold
inline constexpr double kSmallestArc = 1e-9;                 // of the range: smallest step, located end of a branch
inline constexpr double kFirstArc = 0.1;                     // of the longest step
inline constexpr double kArcShrink = 0.3, kArcGrowth = 1.4;  // step factors after failure and success
inline constexpr double kLeastCosine = 0.98;                 // between the tangents of neighbouring points
inline constexpr double kRealMultiplier = 1e-9;              // of the imaginary part: rounding
inline constexpr double kUnitMultiplier = 1e-3;              // distance from 1 of the multiplier at a fold
inline constexpr double kRepeatedImpact = 1e-3;  // relative difference of impact speeds half a period apart: the same
inline constexpr double kNearDoubling = 1e-3;    // of the range: distance at which that doubling is bracketed
inline constexpr double kOnCircle = 1e-7;        // of |μ|² − 1: rounding, as of pairs that never leave the circle
inline constexpr double kAtTip =
    1e-6;  // of the beam's length: a branch that ends with a foot this close ends at a corner
// Relative uncertainty of the parameter at which an interval of sustained contact vanishes: the impacts before it are
// too slow to be separated.
inline constexpr double kRestUncertainty = 3e-5;
// Largest multiplier: times the rounding of the section map it is the residual that is still acceptable.
inline constexpr double kMostUnstable = 1e6;
inline constexpr double kMovedSection = 0.01;  // [rad] smaller changes of the section are ignored
inline constexpr double kNearSection = 0.1;    // of its flight: an impact so close to the section moves it
inline constexpr double kAtRangeEnd = 1e-12;   // of the range: rounding
// The first step onto the doubled branch, as a share of the orbit's size over its turns, is halved so often until there
// is a point on it.
inline constexpr double kDoubledShift = 0.02;
inline constexpr int kDoubledHalvings = 13;

// ---- exponents ----
// Standard errors by which an exponent differs from zero: three times its error.
inline constexpr double kSureErrors = 3;
inline constexpr double kMaxDecay = 5;   // logarithm of the decay of a damped mode between two orthonormalizations
inline constexpr double kUnsettled = 4;  // standard errors between the halves of an average
// Blocks that do not match the period of a periodic motion may differ by this share of the whole.
inline constexpr double kUnsettledRounding = 1e-3;
inline constexpr double kCompliant = 0.02;  // [s] between orthonormalizations with compliant contact
inline constexpr double kNoRank = 1e-13;    // of a unit tangent: a smaller remainder is rounding
inline constexpr double kGrazing = 0.01;    // of the root mean square approach speed: slower impacts are near grazing
// Tolerance of tangents over rtol: their errors enter an exponent once and are not amplified.
inline constexpr double kTangentErrors = 100;
inline constexpr std::size_t kHistory = 400;  // approximate number of points of the convergence history
// Chaos requires that the later half of a motion multiplies differences by more than e^kLateGrowth. Linear growth does
// not.                                                                                                          (S74)
inline constexpr double kLateGrowth = 3;

}  // namespace beamcam::sim
