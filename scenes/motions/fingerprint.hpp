// What decides about pixels besides the program: libraries, fonts, and for lit views the OpenGL driver and the
// processor. Digests of pictures are kept under it.
#pragma once

#include <map>
#include <string>

namespace beamcam::scenes {

struct Fingerprint {
    std::map<std::string, std::string> parts;
    std::string id() const;  // 12 digits: of the SHA-256 of the parts
};

// Of flat views. Throws render::FontError when a font is missing.
Fingerprint flat_fingerprint();
// Of figures: other fonts, of which the Chinese one may be missing.
Fingerprint figure_fingerprint();
// Of lit views: the same, and the driver, which is loaded for it. Throws render::GlError as well.
Fingerprint lit_fingerprint();

// The instructions that numerical libraries choose by: "avx2 fma", "none of avx2, fma, avx512".
std::string processor_path();

}  // namespace beamcam::scenes
