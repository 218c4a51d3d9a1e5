// The drawing of a cam for the drawing office: the outline at 1:1 in its own frame, with the axis, the base circle, the
// sharpest place and the pivot of the lever, dimensions in millimetres.
#pragma once

#include <string>

#include "render/plot/page_canvas.hpp"
#include "sim/cam/lever.hpp"

namespace beamcam::scenes {

// A PDF or SVG, whose page is as large as the drawing needs. Throws PictureError where no page is large enough.
std::string cam_drawing(const sim::Problem& problem, const sim::Lever& lever, render::Medium medium,
                        const render::Document& document);

}  // namespace beamcam::scenes
