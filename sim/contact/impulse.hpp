// Impulsive contact with dry friction at one point: Routh's construction in the plane of impulses,
// ended by Newton's, Poisson's or Stronge's restitution. MODEL.md §9.
//
// Sources: Routh 1860; Wang & Mason 1992; Stronge, "Impact Mechanics", 2000.
#pragma once

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// Response of the contact point to impulses: Δv_n = nn P_n + nt P_t, Δv_t = nt P_n + tt P_t [1/kg].
template <class T>
struct ComplianceOf {
    T nn = 1, nt = 0, tt = 1;  // nn > 0, tt > 0, nn·tt > nt²
};

template <class T>
struct ImpactResultOf {
    T impulse_n = 0, impulse_t = 0;  // [N s]
    T v_n = 0, v_t = 0;              // after [m/s]
};

using Compliance = ComplianceOf<double>;
using ImpactResult = ImpactResultOf<double>;

// v_n < 0 approaches. `friction` is μ >= 0, `restitution` in [0, 1].
ImpactResult resolve_impact(const Compliance& c, double v_n, double v_t, double friction, double restitution,
                            ImpactLaw law);

}  // namespace beamcam::sim
