// The outcomes of a stress campaign: a panel for each grid, a cell for each pair of extremes, in it a stripe for each
// variant, coloured by its outcome. Failures are crossed out as well, so that colour alone does not carry them.
#pragma once

#include <vector>

#include "render/plot/figure.hpp"
#include "sim/studies/stress.hpp"

namespace beamcam::scenes {

// `results` belong to `campaign.cases`, in their order.
render::figure::Figure survival_map(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results);

}  // namespace beamcam::scenes
