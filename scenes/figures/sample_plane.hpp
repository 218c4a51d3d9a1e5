// All samples of a sweep in one plane: a Poincaré section, or a map of each impact to the next.
#pragma once

#include <string>

#include "scenes/figures/swept_points.hpp"

namespace beamcam::scenes {

// `x`, `y`: columns of the samples; `next`: y is that of the sample after. Throws PictureError where there is none.
render::figure::Figure sample_plane(const SweptPoints& points, const std::string& x, const std::string& y, bool next);

}  // namespace beamcam::scenes
