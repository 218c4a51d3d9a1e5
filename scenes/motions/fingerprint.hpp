// The fingerprint of the parts that determine pixels besides the program: libraries, fonts, and for lit views the
// OpenGL driver and the processor. Digests of pictures are stored with it.
#pragma once

#include <map>
#include <string>

namespace beamcam::scenes {

struct Fingerprint {
    std::map<std::string, std::string> parts;
    std::string id() const;  // first 12 digits of the SHA-256 of the parts
};

// The fingerprint of flat views. Throws render::FontError if a font is missing.
Fingerprint flat_fingerprint();
// The fingerprint of figures, which have other fonts; the Chinese one may be missing.
Fingerprint figure_fingerprint();
// The fingerprint of lit views includes the driver, which this loads. Also throws render::GlError.
Fingerprint body_fingerprint();

// The instruction sets by which numerical libraries select code: "x86-64 avx2 fma".
std::string processor_path();

}  // namespace beamcam::scenes
