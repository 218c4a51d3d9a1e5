// The convergence of the Lyapunov exponents of a motion.
#pragma once

#include "render/plot/figure.hpp"
#include "scenes/figures/caption.hpp"
#include "sim/orbit/exponents.hpp"

namespace beamcam::scenes {

// Throws PictureError where every exponent is −∞.
render::figure::Figure exponents_figure(const sim::Exponents& exponents, const sim::Problem& problem, Lang lang);

}  // namespace beamcam::scenes
