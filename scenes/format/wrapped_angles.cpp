#include "scenes/format/wrapped_angles.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace beamcam::scenes {

std::optional<AngleJump> joined_turns(std::vector<double>& angles) {
    constexpr double kRounding = 1e-3;  // of a turn: encoders print few digits
    std::optional<AngleJump> first;
    std::vector<double> joined = angles;
    double least = INFINITY, most = -INFINITY, before = NAN, turns = 0;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        if (!std::isfinite(angles[i])) continue;
        least = std::min(least, angles[i]), most = std::max(most, angles[i]);
        const double jump = std::isfinite(before) ? angles[i] - before : 0;
        if (!first && std::abs(jump) > 0.5 * kFullTurn) first = {i, jump};
        turns -= std::round(jump / kFullTurn);
        joined[i] += turns * kFullTurn;
        before = angles[i];
    }
    if (most - least > (1 + kRounding) * kFullTurn) first.reset();
    if (first) angles = std::move(joined);
    return first;
}

}  // namespace beamcam::scenes
