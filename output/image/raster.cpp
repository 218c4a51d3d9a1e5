#include "output/image/raster.hpp"

#include <bit>
#include <cstring>

#include "output/files/descriptor.hpp"
#include "output/files/digest.hpp"

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

void to_raster(const render::Image& image, Raster& out) {
    out.resize(image.width, image.height);
    rgba_bytes(image.pixels, out.rgba.data());
}

render::Image to_image(const Raster& raster) {
    render::Image image(raster.width, raster.height);
    const std::uint8_t* from = raster.rgba.data();
    for (std::uint32_t& pixel : image.pixels) {
        const std::uint32_t alpha = from[3];
        const auto times_alpha = [alpha](std::uint32_t channel) { return (channel * alpha + 127) / 255; };
        pixel = alpha << 24 | times_alpha(from[0]) << 16 | times_alpha(from[1]) << 8 | times_alpha(from[2]);
        from += 4;
    }
    return image;
}

std::string digest(const Raster& raster) { return sha256(bytes_of(raster.rgba)); }

}  // namespace beamcam::output
