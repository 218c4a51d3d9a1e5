// Numerical constants of the problem's derived values and of the range of its numbers, each with its reason.
#pragma once

namespace beamcam::sim {

// ---- derived values ----
inline constexpr double kPaperDepth = 0.0368;  // [m] depth of the beam with the default section
inline constexpr double kCollisionGap = 0.02;  // [s] "auto" for a beam of 1 m on Earth
inline constexpr double kEarthGravity = 9.81;  // [m/s²] in place of a gravity of zero

// ---- Hertz's contact ----
inline constexpr double kPointExponent = 1.5;      // of spheres
inline constexpr double kLineExponent = 10.0 / 9;  // of Palmgren's δ ~ F^0.9 (1959)
inline constexpr double kPalmgrenFactor = 1.36;    // δ = 1.36 [(η₁ + η₂)F]^0.9/b^0.8, η = (1 − ν²)/E

// ---- the range of the numbers ----
// Squares, cubes and products of a few numbers between these neither overflow nor vanish.
inline constexpr double kSmallestInertia = 1e-60, kLargestInertia = 1e60;  // mass [kg], moment of inertia [kg m²]
inline constexpr double kSmallestScale = 1e-30, kLargestScale = 1e30;      // frequency [rad/s], penetration [m]
inline constexpr double kSpeedOfLight = 299792458;                         // [m/s]
// Positions along the beam are sums with the hub's radius, and the gap is a difference of distances: beyond these
// multiples of the beam's length, rounding leaves fewer than five digits of them.
inline constexpr double kMaxHubRadius = 1e6, kMaxCamSize = 1e9;
// ω₁√(ρAL⁴/(EI)) of a clamped beam, the square of its first eigenvalue.
inline constexpr double kFirstClampedFrequency = 3.5160152685;
// The largest number in a scene, in SI units: products of a few such numbers do not overflow.
inline constexpr double kLargestNumber = 1e30;

}  // namespace beamcam::sim
