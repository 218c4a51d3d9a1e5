// The map of a stress campaign: one field for each plate, a cell for each pair of extremes, in it a stripe for each
// variant, coloured by how it ended. What failed is crossed out as well, so that colour does not carry it alone.
#pragma once

#include <vector>

#include "render/draw/image.hpp"
#include "sim/studies/stress.hpp"

namespace beamcam::render {

// `results` belong to `campaign.cases`, in their order. 1800 pixels wide, as high as it takes. Throws FontError.
Image survival_map(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results);

}  // namespace beamcam::render
