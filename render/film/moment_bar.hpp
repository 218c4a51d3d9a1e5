// The colour scale of the bending moment below the panels.
#pragma once

#include "render/draw/canvas.hpp"
#include "render/film/panel.hpp"

namespace beamcam::render {

void draw_moment_bar(Canvas& canvas, const FilmContext& context);

}  // namespace beamcam::render
