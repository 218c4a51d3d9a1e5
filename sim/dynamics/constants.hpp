// Numerical constants of the equations of motion, each with its reason: foot of the contact, rounding of the gap,
// equilibria at the start, validation, causes of failures.
#pragma once

namespace beamcam::sim {

// ---- the foot of the contact ----
inline constexpr int kMaxFootSteps = 60;      // Newton's method with bisection; bisection alone needs 47 to kFootChange
inline constexpr double kFootChange = 1e-14;  // of the length: rounding error of the arc position
inline constexpr double kLastFootChange = 1e-9;  // of the length: a Newton step this short leaves only rounding errors
// Intervals of a search along the beam, besides 2 or 4 for each coordinate: more for more curved shapes.
inline constexpr int kIntervalsOfModes = 9, kIntervalsOfExact = 13;
inline constexpr double kSingleFoot = 0.5;     // limit of |v″| × distance of the disc; at 1 a second foot can appear
inline constexpr double kLeastShapeBound = 3;  // bounds all shapes of a beam that does not reach beyond its hinge

// ---- the rounding of the gap ----
// Ten times the rounding error of the gap, over the length. Smaller openings and penetrations are rounding.
inline constexpr double kGapRounding = 1e-14;
// Baumgarte rate: kDecayOfVibration of the lowest bending frequency or, of a rigid beam, kDecayOfPendulum of √(g/L). So
// it is slower than vibration and faster than the pendulum.
inline constexpr double kDecayOfVibration = 0.1, kDecayOfPendulum = 10;
inline constexpr double kLeastGravity = 1e-3;  // [m/s²] keeps that rate above zero

// ---- equilibria ----
inline constexpr int kMaxNewtonSteps = 60, kMaxHalvings = 20;  // iterations; halvings of one step
inline constexpr double kNewtonDifference = 1e-7;  // of an unknown's magnitude: step of the finite differences
inline constexpr double kShallowDifference = 0.1;  // of the static penetration: the same in a stiff contact
inline constexpr double kNewtonConverged = 1e-13;  // of an unknown's magnitude: a converged step
// The load mgL²/(EI) grows by this from one equilibrium to the next; up to 7 are followed. A beam that needs more steps
// than the second number is a chain: its load is 5·10³.
inline constexpr double kLoadStep = 5, kMostLoadSteps = 1000;
inline constexpr double kRestingLoadStep = 0.5;   // the same on the cam, which a beam bent in one step would leave
inline constexpr double kEquilibriumGap = 1e-10;  // of the length: largest gap of a beam that rests on the cam
inline constexpr double kSeparatedPull = 1e-6;    // of K: the spring that pulls a separated iterate back to the cam
inline constexpr double kBalanced = 1e-9;         // of the natural forces: largest residual in equilibrium
// [rad] of the cam: steps of finite differences of fourth and second order, at which truncation and rounding errors
// are equal.
inline constexpr double kFollowingDifference = 5e-3, kLeavingDifference = 1e-5;

// ---- validation ----
inline constexpr double kLeastFiniteRestitution = 0.01;  // for dissipation laws with D → ∞ as c → 0
inline constexpr double kStartGap =
    1e-12;  // of the length, at least of 1 m: smaller overlaps at the start are rounding
inline constexpr double kContinuedGap = 1e-9;   // of the same: beam and cam that are said to touch are no farther apart
inline constexpr double kSameExponent = 1e-3;   // of a contact exponent that is written with a few digits
inline constexpr double kFarRestitution = 0.2;  // of the pre-set restitution from that of impacts: worth a warning

// ---- the causes of a failure ----
// Beyond these limits the assumption of small deflections is the most probable cause.
inline constexpr double kLargestSlope = 0.5;     // [rad] between the ends of the beam
inline constexpr double kLargestSag = 0.2;       // of the length: static deflection of the clamped beam
inline constexpr double kFastRotation = 0.5;     // of the first bending frequency: rotation affects the stiffness
inline constexpr double kRunawayRotation = 1e3;  // of that frequency: possible only if the inertia vanished
inline constexpr double kSlowApproach = 1e-5;    // [m/s]: a hundredth of the usual floor
inline constexpr double kNarrowSlip = 1e-4;      // [m/s]: slip speeds below this need short steps
inline constexpr double kSharpTouch = 0.1;       // of the time to maximum penetration: typical step in contact
inline constexpr double kUsableDepth = 0.25;     // of the cam's radius: largest penetration with a meaningful force

}  // namespace beamcam::sim
