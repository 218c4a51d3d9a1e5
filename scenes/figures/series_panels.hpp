// The panels of a series: the curves of its motions, measured data among them, and lines across.
#pragma once

#include <vector>

#include "render/plot/figure.hpp"
#include "scenes/figures/series_plan.hpp"

namespace beamcam::scenes {

// A planned panel; with `keys.residuals` also, below it, what data differ by. `weight`: of the lines.
std::vector<render::figure::Panel> series_panels(const SeriesPlan& plan, const PlannedPanel& planned,
                                                 const Results& results, double weight);

}  // namespace beamcam::scenes
