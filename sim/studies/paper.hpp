// Formulas of the paper, as printed and corrected: static deflection of the supported beam (its eq. 5), fall time of
// the rigid rod, tangent to the cam. MODEL.md §14.
//
// Source: Yang, Feng, Chen & Wu, Acta Physica Sinica 65, 240502 (2016).
#pragma once

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// printed: as in the paper; completed: with the missing terms of C₂ and D₂; corrected: also with the factor 1/cos²θ of
// lengths measured along the inclined beam (S48).
enum class Printing { printed, completed, corrected };

// Deflection v [m] and its derivative v′ = dv/dx [–] by the horizontal distance x, of eq. (5): the beam, inclined by
// `angle`, is supported at the hinge and at the horizontal distance `support` in (0, L cos θ).
struct StaticDeflection {
    double v = 0, slope = 0;
};
// At the horizontal distance `x` in [0, L cos θ] from the hinge. `overhang`: use the expression of the overhanging span
// (at the support both apply).
StaticDeflection supported_beam(const Problem& problem, double angle, double support, double x, Printing printing,
                                bool overhang);

// Time in which a rigid rod falls from rest at `angle` to the horizontal [s], with the gravity torque multiplied by
// `torque_factor`: 1 for the true rod, 2 for the paper's 0.262 s (S51).
double rod_fall_time(double length, double gravity, double angle, double torque_factor);

// Distance x₁ from the hinge at which a line through the hinge is tangent to the disc: √(D² − R²) as printed,
// √(D² + e² + 2De cos ψ − R²) with the eccentricity (S50).
double tangent_distance(const Cam& cam, double psi, Printing printing);

}  // namespace beamcam::sim
