#include "output/film/pixel_layout.hpp"

#include <cstddef>
#include <cstdint>

#include "output/film/yuv.hpp"
#include "output/image/raster.hpp"

namespace beamcam::output {
namespace {

// Bytes of each pixel in the order blue, green, red, alpha; colour not premultiplied.
void copy_pixels(const std::uint32_t* from, int count, std::uint8_t* out) {
    for (int x = 0; x < count; ++x) {
        const StraightColor c = straight_color(from[x]);
        *out++ = static_cast<std::uint8_t>(c.b);
        *out++ = static_cast<std::uint8_t>(c.g);
        *out++ = static_cast<std::uint8_t>(c.r);
        *out++ = static_cast<std::uint8_t>(c.a);
    }
}
void copy_pixels(const render::Image& image, std::uint8_t* to, std::ptrdiff_t stride, const render::DirtyTiles& part) {
    constexpr std::ptrdiff_t kPixel = 4;  // [bytes]
    part.for_each_run([&](int left, int top, int right, int bottom) {
        for (int y = top; y < bottom; ++y)
            copy_pixels(image.pixels.data() + std::ptrdiff_t(y) * image.width + left, right - left,
                        to + y * stride + left * kPixel);
    });
}

}  // namespace

void convert(const render::Image& image, PixelLayout layout, const PaletteTable* table, const FramePlanes& frame,
             const render::DirtyTiles& part) {
    switch (layout) {
        case PixelLayout::yuv420:
            return convert_to_yuv420(image, frame, part);
        case PixelLayout::yuva420:
            return convert_to_yuva420(image, frame, part);
        case PixelLayout::yuva444p10:
            return convert_to_yuva444p10(image, frame, part);
        case PixelLayout::indices:
            return table->convert(image, frame.plane[0], frame.stride[0], part);
        case PixelLayout::bgra:
            return copy_pixels(image, frame.plane[0], frame.stride[0], part);
    }
}

}  // namespace beamcam::output
