// The figures of commands: an assessment of accuracy, periodic orbits, Lyapunov exponents.
#pragma once

#include <vector>

#include "output/data/orbit_records.hpp"
#include "render/plot/figure.hpp"
#include "scenes/figures/caption.hpp"
#include "scenes/scene/scene.hpp"
#include "sim/orbit/exponents.hpp"
#include "sim/studies/accuracy.hpp"

namespace beamcam::scenes {

// Error against run time of every method, and against the number of modes. Throws render::PictureError when nothing was
// measured.
render::figure::Figure accuracy_figure(const sim::Accuracy& accuracy, const Subject& subject);

// Impacts of a sweep of the same key: values of the key and approach speeds [m/s].
struct SweptImpacts {
    std::vector<double> parameter, approach;
};
// Branches of periodic orbits over a parameter in the scene's unit: impact speeds, stable solid and unstable dashed,
// above the impacts of the sweep if there are any. Throws PictureError where no branch has impacts.
render::figure::Figure branches_figure(const output::BranchTable& table, const SweptImpacts& swept, const Scene& scene,
                                       Lang lang);

// The convergence of the Lyapunov exponents of a motion. Throws PictureError where every exponent is −∞.
render::figure::Figure exponents_figure(const sim::Exponents& exponents, const Subject& subject);

}  // namespace beamcam::scenes
