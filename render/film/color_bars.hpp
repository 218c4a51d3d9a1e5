// The colour scales of bending moment and contact trace below the panels, in the units of the charts.
#pragma once

#include <array>
#include <string>

#include "render/film/panel.hpp"

namespace beamcam::render {

// The numbers of the scale of the trace: at its ends, and in the middle.
std::array<std::string, 3> trace_marks(const FilmContext& context);
void draw_color_bars(Canvas& canvas, const FilmContext& context);

}  // namespace beamcam::render
