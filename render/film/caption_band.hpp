// The texts of events in a picture without a mechanism: in a band below the charts, beside each other.
#pragma once

#include "render/film/panel.hpp"

namespace beamcam::render {

void draw_caption_band(Canvas& canvas, const FilmContext& context, const Box& band, int frame);

}  // namespace beamcam::render
