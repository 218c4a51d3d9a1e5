#include "scenes/format/wrapped_angles.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::scenes {

std::optional<std::size_t> first_wrap(const std::vector<double>& angles) {
    constexpr double kRounding = 1e-3;  // of a turn: encoders print few digits
    std::optional<std::size_t> found;
    double least = INFINITY, most = -INFINITY, before = NAN;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        if (!std::isfinite(angles[i])) continue;
        least = std::min(least, angles[i]), most = std::max(most, angles[i]);
        if (!found && std::abs(angles[i] - before) > 0.5 * kFullTurn) found = i;
        before = angles[i];
    }
    return most - least <= (1 + kRounding) * kFullTurn ? found : std::nullopt;
}

void unwrap(std::vector<double>& angles) {
    double before = NAN;
    for (double& angle : angles) {
        if (!std::isfinite(angle)) continue;
        if (std::isfinite(before)) angle -= kFullTurn * std::round((angle - before) / kFullTurn);
        before = angle;
    }
}

}  // namespace beamcam::scenes
