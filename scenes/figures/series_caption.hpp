// The caption of a series.
#pragma once

#include <string>

#include "scenes/figures/caption.hpp"
#include "scenes/figures/series_plan.hpp"

namespace beamcam::scenes {

// "(a)" is the panel 0.
std::string panel_letter(std::size_t panel);

// Names the channels and the x axis.
std::string series_subject(const SeriesKeys& keys, Lang lang);

// `subject`: the first sentence, without its full stop. `figure` must have its panels.
std::string series_caption(const SeriesPlan& plan, const std::string& subject, const render::figure::Figure& figure,
                           const Results& results);

}  // namespace beamcam::scenes
