// Low bounces of impulsive contact: when they count as one impact with sustained contact afterwards. MODEL.md §9,
// (S57).
#pragma once

#include <cmath>

#include "sim/base/numerics.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// Bounces slower than this share of the approach floor are summed up where nothing else changes meanwhile.
inline constexpr double kSummedShare = 0.1;
// Elsewhere a rebound slower than this share of the floor ends the chatter in sustained contact. A bouncing point then
// rests at most 2v/(g(1 − e)) too early (MODEL.md §9).
inline constexpr double kChatterShare = 1e-3;
inline constexpr double kRestSpeed = 1e-12;         // [m/s]: smaller speeds are rounding
inline constexpr double kRestAcceleration = 1e-20;  // [m/s²]: smaller ones are rounding, and move nothing in any run
inline constexpr double kLowestBounce = 1e-13;      // of the beam's length: a hundred times the gap's rounding error
// Conditions of summed-up chatter (S57): its duration times the highest frequency, for an error of (10⁻³)²/6 of the
// last rebound; and the relative change of the acceleration towards the cam.
inline constexpr double kBriefChatter = 1e-3, kSteadyPull = 1e-2;

// Normal speeds before and after an impact [m/s].
struct Bounce {
    double approach, rebound;

    // Slow enough that all further bounces may be summed up.
    bool is_summable(const Contact& contact) const {
        return rebound > kNegligible * approach && rebound < approach &&
               rebound < kSummedShare * contact.approach_floor.value;
    }
    // The time until they end under a constant acceleration towards the cam.
    double chatter_time(double pull) const { return 2 * rebound / (pull * (1 - rebound / approach)); }
    // They end: they are slow, or rounding of the gap keeps low ones from becoming lower.
    bool ends_chatter(double pull, double last_rebound, const Problem& problem) const {
        const bool low = pull > 0 && rebound * rebound < 2 * pull * kLowestBounce * problem.beam.length;
        return rebound < kChatterShare * problem.contact.approach_floor.value || (low && rebound >= last_rebound);
    }
};

// The acceleration towards the cam is the same at both ends of the bounces.
inline bool is_steady(double pull, double later) { return std::fabs(later - pull) < kSteadyPull * pull; }

}  // namespace beamcam::sim
