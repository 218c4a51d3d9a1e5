// Conservative advancement: how far a gap may be followed without missing a touch, from bounds of its second
// derivative. MODEL.md (S56), (S84).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "sim/base/numerics.hpp"

namespace beamcam::sim {

// A gap and its rate at one instant; lengths or angles.
struct GapAt {
    double value, rate;
};

// Bounds of a gap's second derivative, −most <= g̈ <= least. Gaps g >= 0 and their rates v may be lengths or angles.
struct Advancement {
    double most, least;

    // No touch occurs before g + vτ − ½most τ² = 0: this time τ; infinite if there is none.
    double clear_time(double g, double v) const {
        const double pull = std::max(most, 0.0), root = std::sqrt(v * v + 2 * pull * g);
        if (v < 0) return 2 * g / (root - v);
        return pull > 0 ? (v + root) / pull : std::numeric_limits<double>::infinity();
    }
    // A touch has occurred by the time at which g + vτ + ½least τ² = 0, if it falls to zero.
    std::optional<double> certain_time(double g, double v) const {
        const double square = v * v - 2 * least * g;
        if (!(v < 0 && square > 0)) return std::nullopt;
        return 2 * g / (std::sqrt(square) - v);
    }
};

// The zero of a gap that falls from t on, where it is `at`, and vanishes before `latest`: Newton's method with
// bisection, up to `rounding`. Nothing if it is still open at `end`, beyond which gap(t) is not defined.
template <class F>
std::optional<double> falling_zero(F&& gap, double t, GapAt at, double latest, double end, double rounding) {
    double low = t, high = latest;
    for (int i = 0; i < kMostIterations; ++i) {
        double next = t - at.value / at.rate;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        next = std::min(next, end);
        at = gap(next);
        if (next == end && at.value > 0) return {};
        if (next == t || std::fabs(at.value) <= rounding) return next;
        (at.value > 0 ? low : high) = next;
        t = next;
    }
    return t;
}

}  // namespace beamcam::sim
