// The name of a picture: SHA-256 of its pixels as a decoder sees them, never of a file.
#pragma once

#include <string>

#include "render/draw/image.hpp"

namespace beamcam::output {

// Of R, G, B, A bytes, colour not premultiplied, rows top to bottom; what
// `ffmpeg -i still.png -f rawvideo -pix_fmt rgba - | sha256sum` prints.
std::string digest(const render::Image& image);

}  // namespace beamcam::output
