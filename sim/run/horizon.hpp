// During which intervals the motion is reproducible: where a run agrees with another computation of the same motion, by
// another integration method at a tighter tolerance. Impacts multiply small differences, and a motion that settles
// loses them again, so agreement may end and come back. MODEL.md §16.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "sim/run/simulate.hpp"

namespace beamcam::sim {

// Asks for the compared angle (channels.hpp) at 1 kHz up to `end` [s], and there.
Request horizon_request(const Problem& problem, double end);

// How far `plain`, the run's result, is to be compared [s]: up to `end`, or six turns of the cam after the last touch
// where nothing but the turning cam moves it from there on.
double compared_until(const Problem& problem, const Result& plain, double end);
Request cut(Request angle, double until);
// After such a comparison: the two differ so little in the last two turns that they agree until `end` even if all of
// the difference arose there and goes on to grow as fast.
bool agrees_for_good(const Problem& problem, const Request& angle, const Result& plain, const Result& other,
                     double end);

// The computation to compare with. `same_method`: another method would take too many steps for this problem.
struct Comparison {
    Problem problem;
    bool same_method = false;
    std::optional<double> until = {};  // [s] where the same method at a tighter tolerance takes its place
};
Comparison comparison(const Problem& problem, double end);
// The same method at a tighter tolerance.
Comparison tighter_comparison(const Problem& problem);

// True where a run by the same method at a tighter tolerance is much cheaper than one by another. The other is then
// needed only as long as it may tell more [s]: until the motion differs from that run, or a while after the last
// touch.
bool tighter_is_cheap(const Problem& problem);
double other_needed_until(const Problem& problem, const Request& angle, const Result& plain, const Result& tighter);
// Puts the rows of `first`, which may be fewer, in the place of those of `whole`.
void put_first(const Result& first, Result& whole);

// Fills in what a result says of its reproducibility. `angle` is `horizon_request`, cut perhaps; `plain` and `other`
// are its results by the run and by the comparison. Instants that the other did not reach count as not reproducible.
void tell_reproducibility(const Problem& problem, const Request& angle, const Result& plain, const Result& other,
                          const Comparison& compared, Result& result);

}  // namespace beamcam::sim
