// What the caption of a series says.
#pragma once

#include <string>

#include "scenes/figures/caption.hpp"
#include "scenes/figures/series_plan.hpp"

namespace beamcam::scenes {

// "(a)" is the panel 0.
std::string panel_letter(std::size_t panel);

// The channels that it shows, and against what.
std::string series_subject(const SeriesKeys& keys, Lang lang);

// `subject`: what the figure shows, without a full stop. `figure` has its panels.
std::string series_caption(const SeriesPlan& plan, const std::string& subject, const render::figure::Figure& figure,
                           const Results& results);

}  // namespace beamcam::scenes
