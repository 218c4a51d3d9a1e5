// Branches of periodic orbits over a parameter: speeds of the impacts, stable ones solid, unstable ones dashed.
#pragma once

#include "output/data/records.hpp"
#include "render/plot/figure.hpp"
#include "scenes/figures/caption.hpp"

namespace beamcam::scenes {

// Throws PictureError where no branch has impacts.
render::figure::Figure branches_figure(const output::BranchTable& table, const sim::Problem& problem, Lang lang);

}  // namespace beamcam::scenes
