// Identity of the program, of a motion, and of what draws pictures. Equal keys mean equal bits; a key that misses an
// input would give an output the motion of another problem, or keep an outdated file.
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

// The instruction sets by which numerical libraries select code: "x86-64 avx2 fma".
std::string processor_path();

// The fingerprints of the parts that determine pixels besides the program: libraries, fonts, and for lit views the
// OpenGL driver and the processor: the first 12 digits of their SHA-256. Digests of pictures are stored with it. Throw
// render::FontError if a font is missing.
std::string flat_fingerprint();
std::string figure_fingerprint();  // figures have other fonts; the Chinese one may be missing
std::string body_fingerprint();    // loads the driver; also throws render::GlError

}  // namespace beamcam::scenes
