#include "output/image/pixels.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace beamcam::output {

namespace {

std::uint32_t unpremultiplied(std::uint32_t channel, std::uint32_t alpha) {
    return alpha == 0 ? 0 : std::min<std::uint32_t>((channel * 255 + alpha / 2) / alpha, 255);
}

}  // namespace

bool is_opaque(std::span<const std::uint32_t> pixels) {
    std::uint32_t all = 0xff000000;
    for (std::uint32_t pixel : pixels) all &= pixel;
    return all >= 0xff000000;
}

std::string rgba_bytes(const render::Image& image) {
    std::string bytes(image.pixels.size() * 4, '\0');
    rgba_bytes(image.pixels, reinterpret_cast<std::uint8_t*>(bytes.data()));
    return bytes;
}

void rgba_bytes(std::span<const std::uint32_t> pixels, std::uint8_t* out) {
    static_assert(std::endian::native == std::endian::little, "pixels are swapped in memory order");
    if (is_opaque(pixels)) {  // nearly all pictures: blue and red change places, which compilers do many at once
        for (const std::uint32_t pixel : pixels) {
            const std::uint32_t swapped = (pixel & 0xff00ff00) | (pixel >> 16 & 0xff) | (pixel & 0xff) << 16;
            std::memcpy(out, &swapped, 4);
            out += 4;
        }
        return;
    }
    for (const std::uint32_t pixel : pixels) {
        const std::uint32_t alpha = pixel >> 24;
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t channel = pixel >> (16 - 8 * i) & 0xff;
            out[i] = static_cast<std::uint8_t>(alpha == 255 ? channel : unpremultiplied(channel, alpha));
        }
        out[3] = static_cast<std::uint8_t>(alpha);
        out += 4;
    }
}

}  // namespace beamcam::output
