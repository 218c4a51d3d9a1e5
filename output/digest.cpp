#include "output/digest.hpp"

#include "output/pixels.hpp"
#include "output/sha256.hpp"

namespace beamcam::output {

std::string digest(const render::Image& image) { return sha256(rgba_bytes(image)); }

}  // namespace beamcam::output
