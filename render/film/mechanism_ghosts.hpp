// The motions that a mechanism is compared with, in its own view: outlines of their beams and discs, and straight beams
// at measured angles.
#pragma once

#include "render/film/mechanism_view.hpp"

namespace beamcam::render {

// The other motions: under the first one's beam, whose colours mean something, and over it.
void draw_ghost_bodies(const MechanismScene& s);
void draw_ghost_outlines(const MechanismScene& s);
void draw_measured_beams(const MechanismScene& s);

}  // namespace beamcam::render
