// Numerical constants of the contact forces, each with its reason.
#pragma once

namespace beamcam::sim {

// |1 + D δ̇/δ̇₋| below this is rounding: it has no sign, and the clamp of the force is neither on nor off.
inline constexpr double kZeroFactor = 1e-9;
// A bristle whose time constant c/k is below this share of the time to the deepest point of an impact at 1 m/s follows
// its force without lag: to resolve the lag would take a thousand steps and more in each contact.
inline constexpr double kShortestLag = 1e-3;

}  // namespace beamcam::sim
