// Identity of the program and of a motion. Equal keys mean equal bits; a key that misses an input would give an output
// the motion of another problem, or keep an outdated file.
#pragma once

#include <string>

#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// Version and build of this program, the libraries that it is linked with and its modules, and the instruction set that
// selects code paths. It does not depend on which modules a command has loaded.
const std::string& program_identity();

// Everything that determines the motion: the physics and the solver's settings, as a scene writes them. It excludes the
// end time, because a shorter run is a prefix of a longer one.
std::string motion_key(const sim::Problem& problem);

}  // namespace beamcam::scenes
