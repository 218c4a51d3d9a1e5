#include "output/image/pixels.hpp"

#include <bit>
#include <cstring>

namespace beamcam::output {

bool is_opaque(std::span<const std::uint32_t> pixels) {
    std::uint32_t all = 0xff000000;
    for (std::uint32_t pixel : pixels) all &= pixel;
    return all >= 0xff000000;
}

void rgba_bytes(std::span<const std::uint32_t> pixels, std::uint8_t* out) {
    static_assert(std::endian::native == std::endian::little, "pixels are swapped in memory order");
    if (is_opaque(pixels)) {  // nearly all pictures: exchanging blue and red is vectorized
        for (const std::uint32_t pixel : pixels) {
            const std::uint32_t swapped = (pixel & 0xff00ff00) | (pixel >> 16 & 0xff) | (pixel & 0xff) << 16;
            std::memcpy(out, &swapped, 4);
            out += 4;
        }
        return;
    }
    for (const std::uint32_t pixel : pixels) {
        const StraightColor c = straight_color(pixel);
        for (const int channel : {c.r, c.g, c.b, c.a}) *out++ = static_cast<std::uint8_t>(channel);
    }
}

}  // namespace beamcam::output
