// Decoded pixels: R, G, B, A bytes, colour not premultiplied, rows from top to bottom. Digests and comparisons use this
// form; render::Image is the form for drawing.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "render/draw/image.hpp"

namespace beamcam::output {

// Sides of the pictures that beamcam draws, encodes and reads [px]. Below 16 nothing can be drawn; 16384 is the largest
// viewport of OpenGL and the largest side of x264. Other pictures are rejected before memory is allocated for them.
constexpr int kSmallestSide = 16, kLargestSide = 16384;

struct Raster {
    int width = 0, height = 0;  // [px]
    std::vector<std::uint8_t> rgba;

    Raster() = default;
    Raster(int w, int h) { resize(w, h); }
    void resize(int w, int h) {
        width = w;
        height = h;
        rgba.resize(std::size_t(w) * std::size_t(h) * 4);
    }
    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
    const std::uint8_t* at(int x, int y) const {
        return rgba.data() + 4 * (std::size_t(y) * std::size_t(width) + std::size_t(x));
    }
    bool operator==(const Raster&) const = default;
};

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

bool is_opaque(std::span<const std::uint32_t> pixels);  // every one of them
// Writes R, G, B, A of each pixel, in four bytes each.
void rgba_bytes(std::span<const std::uint32_t> pixels, std::uint8_t* out);

void to_raster(const render::Image& image, Raster& out);
// Premultiplies transparent pixels, which loses precision.
render::Image to_image(const Raster& raster);

// SHA-256 of the bytes, as `ffmpeg -i still.png -f framehash -hash sha256 -pix_fmt rgba -` prints it.
std::string digest(const Raster& raster);

}  // namespace beamcam::output
