// The figure of an accuracy assessment: error against run time of every method, and against the number of modes.
#pragma once

#include "render/plot/figure.hpp"
#include "scenes/scene/scene.hpp"
#include "sim/studies/accuracy.hpp"

namespace beamcam::scenes {

// Throws render::PictureError when nothing was measured.
render::figure::Figure accuracy_figure(const sim::Accuracy& accuracy, const sim::Problem& problem, Lang lang);

}  // namespace beamcam::scenes
