// Numerical constants of the models of the beam, each with its reason.
#pragma once

#include <cstddef>

namespace beamcam::sim {

inline constexpr int kShapePlaces = 101;        // points of a natural mode: a polyline of 20 waves looks smooth
inline constexpr int kPlacesPerWave = 32;       // where natural modes are evaluated for their largest values
inline constexpr double kBetweenPlaces = 1.05;  // a sine between places a 32nd of a half wave apart: 1.0012
inline constexpr double kUncoupledDamping =
    1e-9;                                     // of the largest entry of C_d: smaller off-diagonal ones are rounding
inline constexpr double kLostInertia = 1e-9;  // of the straight beam's inertia: anything less counts as not positive
// The step of the finite differences of centrifugal forces [length, or rad]; their error is of fourth order, 1e-12.
inline constexpr double kDeflectionDifference = 1e-3;
// Tables: fewer values do not show that they are multiples of a step; and the largest distance from a multiple, as a
// share of the step, to which a table in text rounds its values.
inline constexpr std::size_t kFewestSteppedValues = 20;
inline constexpr double kStepError = 0.15;
inline constexpr double kLeastLogSmoothing = -14;  // of the dimensionless λ: the spline passes through the points

}  // namespace beamcam::sim
