#include "output/image/raster.hpp"

#include "output/files/descriptor.hpp"
#include "output/files/digest.hpp"
#include "output/image/pixels.hpp"

namespace beamcam::output {

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
