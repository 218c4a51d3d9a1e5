// Numerical constants of the models of the beam, each with its reason.
#pragma once

namespace beamcam::sim {

inline constexpr int kShapePlaces = 101;           // of a natural mode: a polyline of 20 waves is smooth
inline constexpr double kUncoupledDamping = 1e-9;  // of the largest damping: coupling by rounding
inline constexpr double kLostInertia = 1e-9;       // of the straight beam's inertia: less is none
// Of the length, or rad: centrifugal forces by differences, whose error of the fifth order is rounding.
inline constexpr double kDeflectionDifference = 1e-3;

}  // namespace beamcam::sim
