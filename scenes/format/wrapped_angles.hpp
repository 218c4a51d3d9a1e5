// Angles that begin again after a turn, as those of absolute encoders.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sim/cam/motion_law.hpp"

namespace beamcam::scenes {

using sim::kFullTurn;

struct AngleJump {
    std::size_t row = 0;
    double angle = 0;  // from the row before [rad]
};
// Adds whole turns so that no row is farther than half a turn from the row before, unless the values span more than a
// turn and so do not wrap. Returns the first jump; nothing: there is none. NaN: no value.
std::optional<AngleJump> joined_turns(std::vector<double>& angles);

}  // namespace beamcam::scenes
