// The paper's own formulas, as printed and as they should read: static deflection of the supported
// beam (its eq. 5), the rod with doubled torque. MODEL.md §14.
//
// Source: Yang, Feng, Chen & Wu, Acta Physica Sinica 65, 240502 (2016).
#pragma once

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// printed: as in the paper; completed: with the missing terms; corrected: also measured along the inclined rod.
enum class Printing { printed, completed, corrected };

// Deflection w(x) of eq. (5) and its slope, x horizontal from the hinge: the beam inclined by `angle`,
// supported at the hinge and at the horizontal distance `support` in (0, L cos θ). [m], [–]
struct StaticDeflection {
    double w = 0, slope = 0;
};
// `x` in [0, L cos θ]. `completed` completes C₂ and D₂, `corrected` also measures along the inclined rod (1/cos²θ).
// `overhang`: evaluate the expression of the overhanging span (at the support both apply).
StaticDeflection supported_beam(const Problem& problem, double angle, double support, double x, Printing printing,
                                bool overhang);

// Time for the rigid rod with the gravity torque multiplied by `torque_factor` to fall from `angle` at
// rest to the horizontal [s]: 1 is the exact rod, 2 what gives the paper's 0.262 s. Exact quadrature.
double rod_fall_time(double length, double gravity, double angle, double torque_factor);

// The distance x₁ from the hinge at which a line from the hinge touches the disc: √(D² − R²) as printed
// (axis), √(D² + e² + 2De cos ψ − R²) with the eccentricity (S50).
double tangent_distance(const Cam& cam, double psi, Printing printing);

}  // namespace beamcam::sim
