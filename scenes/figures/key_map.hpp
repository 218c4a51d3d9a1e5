// A map over two keys: the class of each motion, or a number of it, as colours.
#pragma once

#include <string>

#include "scenes/figures/swept_points.hpp"

namespace beamcam::scenes {

// Values of a map besides the columns of the samples; the first is the default.
inline constexpr const char* kMapValues[] = {"class", "exponent", "impacts_per_period"};

// `value`: "class", "exponent", "impacts_per_period" or a column of the samples, whose mean is shown; empty: the class.
// Throws PictureError for another, or where no point has the number.
render::figure::Figure key_map(const SweptPoints& points, const std::string& value);

}  // namespace beamcam::scenes
