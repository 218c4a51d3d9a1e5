// The fingerprint of the parts that determine pixels besides the program: libraries, fonts, and for lit views the
// OpenGL driver and the processor: the first 12 digits of their SHA-256. Digests of pictures are stored with it.
#pragma once

#include <string>

namespace beamcam::scenes {

// The fingerprint of flat views. Throws render::FontError if a font is missing.
std::string flat_fingerprint();
// The fingerprint of figures, which have other fonts; the Chinese one may be missing.
std::string figure_fingerprint();
// The fingerprint of lit views includes the driver, which this loads. Also throws render::GlError.
std::string body_fingerprint();

// The instruction sets by which numerical libraries select code: "x86-64 avx2 fma".
std::string processor_path();

}  // namespace beamcam::scenes
