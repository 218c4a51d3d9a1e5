// Films that tell what happens. A story stands for keys that a user could have written: speeds in intervals, freezes,
// captions, movements of the camera and a layout; their times and numbers come from the events of the motion.
//
// "impact" tells one collision, from the fall to the rebound; "settle" the way from the fall to the contact that lasts.
#pragma once

#include "scenes/plan/resolve.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// The film with these keys in place of its story. `motion` contains the collisions and apexes until the end of the
// scene. Throws render::PictureError if the motion has no such story.
PictureOutput told(PictureOutput film, const Scene& scene, const sim::Result& motion, const FindEvents& find);

}  // namespace beamcam::scenes
