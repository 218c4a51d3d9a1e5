// Numerical constants of orbits, branches and exponents, each with its reason.
#pragma once

#include <cstddef>

namespace beamcam::sim {

// ---- tangents ----
inline constexpr int kTangentMemories = 2;         // rows beside the coordinates and their rates: z and δ̇₋
inline constexpr double kTangentRounding = 1e-14;  // of a tangent's error in a step: shorter steps gain nothing
// An error falls with this power of a step's length, at least; a level of the ladder is a factor √2.
inline constexpr int kTangentOrder = 8;
inline constexpr double kSameLength = 1e-13;  // of a step: rounding of the time
inline constexpr double kPlastic = 1e-9;      // of the approach speed: a slower rebound is none
// Touches with this share of difference in speed are one and the same: the gap's rounding was taken out between.
inline constexpr double kSameSpeed = 1e-9;

// ---- the section map and its fixed points ----
inline constexpr double kTightRtol = 1e-12, kTightAtol = 1e-14;  // Newton's method needs what rounding allows
inline constexpr int kMostMapSteps = 3'000'000;  // of one section map: no orbit that is worth it needs more
inline constexpr int kMostOrbitNewton = 16;      // iterations
// Residual over the orbit's size: converged, and what is still taken where rounding allows no better.
inline constexpr double kOrbitConverged = 1e-11, kOrbitAcceptable = 1e-8;
inline constexpr double kLongestStep = 0.5;  // of the size, in one iteration
inline constexpr double kReturn = 0.2;  // of the size: a state so near after some turns is worth a Newton iteration
inline constexpr int kThrows = 24;  // cam angles from which the beam is thrown; as many between them if that is no use
inline constexpr double kRise = 0.4;        // of the period: the thrown beam is in flight there
inline constexpr double kAboveCam = 1e-6;   // [rad] so that the throw does not begin with a touch
inline constexpr double kSameOrbit = 1e-6;  // of the speed of an impact: orbits nearer than that are one

// ---- branches ----
inline constexpr int kMostArcNewton = 8;  // iterations; a prediction that needs more is shortened
// Residual of the corrector, in sizes of the orbit: converged; still taken where rounding allows no better.
inline constexpr double kArcConverged = 1e-11, kArcAcceptable = 1e-9;
// Of the range: the derivative by the parameter, which only steers the corrector.
inline constexpr double kArcDifference = 1e-6;
inline constexpr double kSmallestArc = 1e-9;                 // of the range: what stops the branch is located so far
inline constexpr double kFirstArc = 0.1;                     // of the longest step
inline constexpr double kArcShrink = 0.3, kArcGrowth = 1.4;  // of a step that failed, that went well
inline constexpr double kLeastCosine = 0.98;                 // between the tangents of neighbouring points
inline constexpr double kRealMultiplier = 1e-9;              // of the imaginary part: rounding
inline constexpr double kOnCircle = 1e-7;  // of |μ|² − 1: rounding, as of pairs that never leave the circle
inline constexpr double kAtTip = 1e-6;  // of the beam's length: so near to the tip a branch that stops is at a corner
// Of the parameter where a part of rest on the cam ends: its last impacts are too slow to be told apart.
inline constexpr double kRestUncertainty = 3e-5;
inline constexpr double kMovedSection = 0.01;  // [rad] a section that moves by less stays
inline constexpr double kAtRangeEnd = 1e-5;    // of the range; what lies beyond it may be impossible
inline constexpr double kDoubledShift = 0.02;  // of the orbit's size: where the doubled branch is begun

// ---- exponents ----
// Between two orthonormalizations no damped mode decays by more than this factor's logarithm.
inline constexpr double kMostDecay = 5;
inline constexpr double kUnsettled = 4;  // standard errors between the halves of an average
// Of the whole: blocks of a periodic motion may agree better than they cut it.
inline constexpr double kUnsettledRounding = 1e-3;
inline constexpr double kCompliant = 0.02;  // [s] between orthonormalizations where a contact lasts
inline constexpr double kNoRank = 1e-13;    // of a unit tangent: what is left of it is rounding
inline constexpr double kGrazing = 0.01;    // of the typical approach speed: slower impacts are near grazing
// Relative errors of a tangent, in a step, in units of rtol: they enter an exponent once, and are not multiplied.
inline constexpr double kTangentErrors = 100;
inline constexpr std::size_t kHistory = 400;  // points of the convergence, at most about
// Chaos needs that the later half of a motion alone multiplies differences by more than the exponential of this: linear
// growth does not.                                                                                              (S89)
inline constexpr double kLateGrowth = 3;

}  // namespace beamcam::sim
