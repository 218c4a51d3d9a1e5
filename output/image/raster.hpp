// Decoded pixels: R, G, B, A bytes, colour not premultiplied, rows from top to bottom. Digests and comparisons use this
// form; render::Image is the form for drawing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "render/draw/image.hpp"

namespace beamcam::output {

// Larger pictures than beamcam draws are rejected before memory is allocated for them.
constexpr int kLargestSide = 16384;  // [px]

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

void to_raster(const render::Image& image, Raster& out);
// Premultiplies transparent pixels, which loses precision.
render::Image to_image(const Raster& raster);

// SHA-256 of the bytes, as `ffmpeg -i still.png -f framehash -hash sha256 -pix_fmt rgba -` prints it.
std::string digest(const Raster& raster);

}  // namespace beamcam::output
