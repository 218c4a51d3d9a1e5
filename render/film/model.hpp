// A motion as a binary glTF 2.0 model (.glb), which Blender, slides and browsers play: the beam is a mesh of constant
// vertices on a chain of joints, one for each station, that translate and rotate; hub and cam rotate. Metres, Y up, the
// motion in the plane z = 0. Deflection is exaggerated as in films; extras of the asset tell the factor.
#pragma once

#include <string>

#include "render/film/film.hpp"

namespace beamcam::render {

// The setup's frames are the keys of all tracks but the cam's, whose rotation is even. The same setup gives the same
// bytes.
std::string glb_model(const FilmSetup& setup);

}  // namespace beamcam::render
