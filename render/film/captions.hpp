// Words on plates over a mechanism, with a line to what they belong to.
#pragma once

#include "render/film/mechanism_view.hpp"

namespace beamcam::render {

void draw_captions(const MechanismScene& s);

}  // namespace beamcam::render
