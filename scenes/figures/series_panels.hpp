// The panels of a series: the curves of its motions, measured data and lines at instants.
#pragma once

#include <vector>

#include "render/plot/figure.hpp"
#include "scenes/figures/series_plan.hpp"

namespace beamcam::scenes {

// A planned panel; with `keys.residuals` also a panel of the differences of the data. `weight`: of the lines.
std::vector<render::figure::Panel> series_panels(const SeriesPlan& plan, const PlannedPanel& planned,
                                                 const Results& results, double weight);

// Whether lines mark collisions because the impacts between these instants are too many to distinguish.
bool marks_collisions(const sim::Result& result, double from, double to);

}  // namespace beamcam::scenes
