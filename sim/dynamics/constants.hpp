// Numerical constants of the equations of motion, each with its reason: the foot of the contact, bounds of the gap,
// equilibria at the start, the causes of a failure.
#pragma once

namespace beamcam::sim {

// ---- the foot of the contact ----
inline constexpr int kMostFootSteps =
    60;  // of Newton's method with bisection: bisection alone needs 47 for kFootChange
inline constexpr double kFootChange = 1e-14;     // of the length: rounding of the arc position
inline constexpr double kLastFootChange = 1e-9;  // of the length: after such a Newton step what is left is rounding
// Places of a search along the beam, and 2 or 4 a coordinate: more for more curved shapes.
inline constexpr int kPlacesOfModes = 9, kPlacesOfExact = 13;
inline constexpr double kSingleFoot = 0.5;     // of |v″| times the distance of the disc: 1 would be a second foot
inline constexpr double kLeastShapeBound = 3;  // of all shapes of a beam that does not reach beyond its hinge

// ---- the rounding of the gap ----
// The gap is known to a tenth of this share of the beam's length: what opens or falls no further is rounding.
inline constexpr double kGapRounding = 1e-14;
// It decays at a rate slower than the lowest vibration, faster than a rigid beam's swing.
inline constexpr double kDecayOfVibration = 0.1, kDecayOfSwing = 10;
inline constexpr double kLeastGravity = 1e-3;  // [m/s²] so that the rate does not vanish with it

// ---- equilibria ----
inline constexpr int kMostNewtonSteps = 60, kMostDampings = 20;  // halvings of one step of Newton's method
inline constexpr double kNewtonDifference = 1e-7;                // of an unknown's size: differences of its residuals
inline constexpr double kNewtonConverged = 1e-13;                // of an unknown's size
inline constexpr double kBalanced = 1e-9;         // of the natural forces: what is left of a residual in equilibrium
inline constexpr double kEquilibriumGap = 1e-10;  // of the length: what Newton's method leaves of a gap
inline constexpr double kSeparatedPull = 1e-6;    // of the stiffness, by which Newton's method pulls a lifted beam back
// [rad] of the cam: rounding and the error of the differences balance, of the fourth and of the second order.
inline constexpr double kFollowingDifference = 5e-3, kLeavingDifference = 1e-5;

// ---- what a scene may ask for ----
// No number of a mechanism is larger, in SI; squares and products of a few such numbers stay far from overflow.
inline constexpr double kLargestNumber = 1e30;
inline constexpr double kLeastFiniteRestitution = 0.01;  // for laws whose damping has no limit at 0
inline constexpr double kStartGap = 1e-12;               // of the length, 1 m at least: a start that deep is a touch

// ---- the causes of a failure ----
// Beyond these a modal model's small deflections are the likelier cause than anything that they lead to.
inline constexpr double kLargestSlope = 0.5;   // [rad], between the ends of the beam
inline constexpr double kLargestSag = 0.2;     // of the length, of the clamped beam under its weight
inline constexpr double kFastSpin = 0.5;       // of the first bending frequency: turning matters to the stiffness
inline constexpr double kRunawaySpin = 1e3;    // of that frequency: only a vanished inertia lets a hub turn so fast
inline constexpr double kSlowApproach = 1e-5;  // [m/s]: a hundredth of the usual floor
inline constexpr double kSharpTouch = 0.1;     // of the time to the deepest point: what a step in a touch may span

}  // namespace beamcam::sim
