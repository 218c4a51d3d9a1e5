// Conservative advancement: how far a gap may be followed without missing a touch, from bounds of its second
// derivative. MODEL.md (S56), (S84).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace beamcam::sim {

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

}  // namespace beamcam::sim
