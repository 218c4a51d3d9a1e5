// Reproducibility: the intervals in which a run agrees with a second computation of the same motion, by another
// integration method at a tighter tolerance. Impacts amplify small differences and a settling motion loses them, so
// agreement may end and return. MODEL.md §16.
#pragma once

#include <optional>

#include "sim/observe/request.hpp"
#include "sim/observe/result.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// Requests the compared angle (channels.hpp) at 1 kHz up to `end` [s], and at `end`.
Request horizon_request(const Problem& problem, double end);

// End of the comparison of the run's result `plain` [s]: `end`, or six turns of the cam after the last touch if from
// there on only the rotation of the cam changes with time.
double compared_until(const Problem& problem, const Result& plain, double end);
Request cut(Request angle, double until);
// After such a shortened comparison: true if the motions agree until `end` even if their difference in the last two
// turns arose there and continues to grow as fast.
bool agrees_for_good(const Problem& problem, const Request& angle, const Result& plain, const Result& other,
                     double end);

// The second computation.
struct Comparison {
    Problem problem;
    bool same_method = false;          // another method would take too many steps
    std::optional<double> until = {};  // from here on the same method at a tighter tolerance replaces the other [s]
};
Comparison comparison(const Problem& problem, double end);
// A comparison by the motion's own method at a tighter tolerance.
Comparison tighter_comparison(const Problem& problem);

// True if a run by the same method at a tighter tolerance is much cheaper than one by another method. The other method
// is then needed only until the motion differs from that run, or for a short time after the last touch [s].
bool tighter_is_cheap(const Problem& problem);
double other_needed_until(const Problem& problem, const Request& angle, const Result& plain, const Result& tighter);

// Sets the reproducibility fields of `result`. `angle` is the `horizon_request`, possibly cut; `plain` and `other` are
// its results by the run and by the comparison. Instants that `other` did not reach count as not reproducible.
void report_reproducibility(const Problem& problem, const Request& angle, const Result& plain, const Result& other,
                            const Comparison& compared, Result& result);

}  // namespace beamcam::sim
