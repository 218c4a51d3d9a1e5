// The pixels of an Image as bytes, colour not premultiplied, for files and digests.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

namespace beamcam::output {

// A pixel with its colour not premultiplied: c = round(255 c' / a) for the premultiplied c', 0 for a = 0.
struct StraightColor {
    int r = 0, g = 0, b = 0, a = 0;
};
inline StraightColor straight_color(std::uint32_t pixel) {
    const int a = static_cast<int>(pixel >> 24);
    const auto channel = [&](int shift) {
        const int c = static_cast<int>(pixel >> shift & 255);
        return a == 255 ? c : std::min((255 * c + a / 2) / a, 255);
    };
    return a == 0 ? StraightColor{} : StraightColor{channel(16), channel(8), channel(0), a};
}

bool is_opaque(std::span<const std::uint32_t> pixels);

// Writes R, G, B, A of each pixel, in four bytes each.
void rgba_bytes(std::span<const std::uint32_t> pixels, std::uint8_t* out);

}  // namespace beamcam::output
