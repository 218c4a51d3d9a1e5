// Reproducibility: the intervals in which a run agrees with a second computation of the same motion, by another
// integration method at a tighter tolerance. Impacts amplify small differences and a settling motion loses them, so
// agreement may end and return. MODEL.md §16.
#pragma once

#include "sim/observe/request.hpp"
#include "sim/observe/result.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

inline constexpr double kReproducible = 1e-6;      // [rad], or relative to angles above 1 rad
inline constexpr double kTighterTolerance = 1e-2;  // of the tolerance: that of the comparison

// Requests the compared angle (channels.hpp) at 1 kHz up to `end` [s], and at `end`.
Request horizon_request(const Problem& problem, double end);

// The second computation.
struct Comparison {
    Problem problem;
    bool same_method = false;  // another method would take too many steps
};
Comparison comparison(const Problem& problem, double end);
// A comparison by the motion's own method at a tighter tolerance.
Comparison tighter_comparison(const Problem& problem);

// Sets the reproducibility fields of `result`. `plain` and `other` are the results of the request `angle` by the run
// and by the comparison. Instants that `other` did not reach count as not reproducible.
void report_reproducibility(const Problem& problem, const Request& angle, const Result& plain, const Result& other,
                            const Comparison& compared, Result& result);

}  // namespace beamcam::sim
