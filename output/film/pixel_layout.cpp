#include "output/film/pixel_layout.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "output/film/yuv.hpp"

namespace beamcam::output {
namespace {

// Bytes of each pixel in the order named, colour not premultiplied.
void copy_pixels(const std::uint32_t* from, int count, PixelLayout layout, std::uint8_t* out) {
    for (int x = 0; x < count; ++x) {
        const std::uint32_t p = from[x], a = p >> 24;
        std::uint32_t r = p >> 16 & 255, g = p >> 8 & 255, b = p & 255;
        if (a != 0 && a != 255) r = (255 * r + a / 2) / a, g = (255 * g + a / 2) / a, b = (255 * b + a / 2) / a;
        if (layout == PixelLayout::bgra) std::swap(r, b);
        *out++ = static_cast<std::uint8_t>(r);
        *out++ = static_cast<std::uint8_t>(g);
        *out++ = static_cast<std::uint8_t>(b);
        if (layout != PixelLayout::rgb) *out++ = static_cast<std::uint8_t>(a);
    }
}
void copy_pixels(const render::Image& image, PixelLayout layout, std::uint8_t* to, std::ptrdiff_t stride,
                 const render::DirtyTiles& part) {
    const std::ptrdiff_t size = layout == PixelLayout::rgb ? 3 : 4;
    part.for_each_run([&](int left, int top, int right, int bottom) {
        for (int y = top; y < bottom; ++y)
            copy_pixels(image.pixels.data() + std::ptrdiff_t(y) * image.width + left, right - left, layout,
                        to + y * stride + left * size);
    });
}

}  // namespace

void convert(const render::Image& image, PixelLayout layout, const PaletteTable* table, const FramePlanes& frame,
             const render::DirtyTiles& part) {
    YuvaPlanes planes;
    for (std::size_t i = 0; i < 4; ++i) {
        planes.plane[i] = frame.plane[i];
        planes.stride[i] = frame.stride[i];
    }
    switch (layout) {
        case PixelLayout::yuv420:
            return convert_to_yuv420(image,
                                     {{planes.plane[0], planes.plane[1], planes.plane[2]},
                                      {planes.stride[0], planes.stride[1], planes.stride[2]}},
                                     part);
        case PixelLayout::yuva420:
            return convert_to_yuva420(image, planes, part);
        case PixelLayout::yuva444p10:
            return convert_to_yuva444p10(image, planes, part);
        case PixelLayout::indices:
            return table->convert(image, planes.plane[0], planes.stride[0], part);
        case PixelLayout::bgra:
        case PixelLayout::rgba:
        case PixelLayout::rgb:
            return copy_pixels(image, layout, planes.plane[0], planes.stride[0], part);
    }
}

}  // namespace beamcam::output
