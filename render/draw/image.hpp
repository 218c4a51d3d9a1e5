// A picture in memory, in Cairo's native layout, so that drawing, encoding and hashing share one buffer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace beamcam::render {

// 32-bit pixels 0xAARRGGBB in native byte order (B, G, R, A in memory on little-endian machines),
// colour premultiplied by alpha, rows top to bottom, stride exactly 4·width bytes.
struct Image {
    int width = 0, height = 0;  // [px]
    std::vector<std::uint32_t> pixels;

    Image() = default;
    Image(int w, int h) : width(w), height(h), pixels(std::size_t(w) * std::size_t(h), 0) {}
    bool operator==(const Image&) const = default;
};

}  // namespace beamcam::render
