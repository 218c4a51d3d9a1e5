// Angles that begin again after a turn, as those of absolute encoders.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sim/cam/motion_law.hpp"

namespace beamcam::scenes {

using sim::kFullTurn;

// Index of the first row that is farther than half a turn from the row before; nothing: there is none, or the values
// span more than a turn, so that they do not wrap. NaN: no value.
std::optional<std::size_t> first_wrap(const std::vector<double>& angles);

// Adds whole turns so that no row is farther than half a turn from the row before.
void unwrap(std::vector<double>& angles);

}  // namespace beamcam::scenes
