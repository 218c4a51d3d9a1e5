// Numerical constants of the contact forces, each with its reason.
#pragma once

namespace beamcam::sim {

// |1 + D δ̇/δ̇₋| below this is rounding: it has no sign, and the clamp of the force is neither on nor off.
inline constexpr double kZeroFactor = 1e-9;

}  // namespace beamcam::sim
