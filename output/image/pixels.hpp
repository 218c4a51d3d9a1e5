// The pixels of an Image as files and digests see them: bytes, colour not premultiplied.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "render/draw/image.hpp"

namespace beamcam::output {

bool is_opaque(std::span<const std::uint32_t> pixels);

// R, G, B, A per pixel, rows top to bottom: c = round(255 c' / a) for the premultiplied c', 0 where a = 0.
std::string rgba_bytes(const render::Image& image);
// The same of some pixels, into four bytes each of the caller's.
void rgba_bytes(std::span<const std::uint32_t> pixels, std::uint8_t* out);

}  // namespace beamcam::output
