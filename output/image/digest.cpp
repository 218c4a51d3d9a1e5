#include "output/image/digest.hpp"

#include "output/files/sha256.hpp"
#include "output/image/pixels.hpp"

namespace beamcam::output {

std::string digest(const render::Image& image) { return sha256(rgba_bytes(image)); }

}  // namespace beamcam::output
