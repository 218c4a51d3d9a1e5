// Branches of periodic orbits over a parameter: impact speeds, stable solid and unstable dashed, above the impacts of
// a sweep if it is given.
#pragma once

#include "output/data/orbit_records.hpp"
#include "render/plot/figure.hpp"
#include "scenes/figures/caption.hpp"

namespace beamcam::scenes {

// Impacts of a sweep of the same key: values of the key and approach speeds [m/s].
struct SweptImpacts {
    std::vector<double> parameter, approach;
};
// Throws PictureError where no branch has impacts.
render::figure::Figure branches_figure(const output::BranchTable& table, const SweptImpacts& swept,
                                       const sim::Problem& problem, Lang lang);

}  // namespace beamcam::scenes
