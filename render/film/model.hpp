// A motion as a binary glTF 2.0 model (.glb) for Blender, slides and browsers: the beam is a skinned mesh with joints
// along it, hub and cam are rotating nodes. Metres, Y up, motion in the plane z = 0. Deflection is exaggerated as in
// films; the extras of the asset contain the factor.
#pragma once

#include <string>

#include "render/film/film.hpp"

namespace beamcam::render {

// The setup's frames are the keys of all tracks except the cam's, whose rotation is uniform. The result depends only on
// the setup.
std::string glb_model(const FilmSetup& setup);

}  // namespace beamcam::render
