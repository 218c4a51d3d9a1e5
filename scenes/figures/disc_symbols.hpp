// The symbols of the cam's disc: R, e, B, C and ω, placed so that they keep clear of each other.
#pragma once

#include "scenes/figures/sketch.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::scenes {

// On the disc drawn `zoom` times as large, its centre B here. `letter`: size of letters, in radii.
void draw_disc_symbols(const sim::Cam& cam, sim::Vec2 b, double zoom, double letter, Sketch& to);

}  // namespace beamcam::scenes
