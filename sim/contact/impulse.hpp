// Impulsive contact with dry friction at one point: Routh's construction in the plane of impulses, terminated by
// Newton's, Poisson's or Stronge's law of restitution. MODEL.md §9.
//
// Sources: Routh 1860; Wang & Mason 1992; Stronge, "Impact Mechanics", 2000.
#pragma once

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// Response of the contact point to impulses: Δv_n = nn P_n + nt P_t, Δv_t = nt P_n + tt P_t [1/kg].
struct Compliance {
    double nn = 1, nt = 0, tt = 1;  // nn > 0, tt >= 0, nn·tt >= nt²
};

struct ImpactResult {
    double impulse_n = 0, impulse_t = 0;  // [N s]
    double v_n = 0, v_t = 0;              // after [m/s]
};

// v_n < 0 approaches. `friction` is μ >= 0, `restitution` in [0, 1]. Throws ContactLocked where no impulse ends
// the impact (jamming of a singular compliance).
ImpactResult resolve_impact(const Compliance& c, double v_n, double v_t, double friction, double restitution,
                            ImpactLaw law);

}  // namespace beamcam::sim
