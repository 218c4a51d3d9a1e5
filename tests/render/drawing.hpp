// Helpers for tests of films.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "render/draw/fonts.hpp"
#include "render/film/film.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SKIP_WITHOUT_GL() GTEST_SKIP() << "the software OpenGL driver is not built for sanitizers"
#else
#define SKIP_WITHOUT_GL() (void)0
#endif

namespace beamcam::render {

// Without the Chinese fonts.
inline const Fonts& fonts() {
    static const Fonts loaded(false);
    return loaded;
}

inline Image drawn(Film& film, int frame) {
    Image image;
    film.draw(frame, image);
    return image;
}

inline std::uint32_t pixel_at(const Image& image, int x, int y) {
    return image.pixels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
}

// The sum of the differences of the channels, each 0…1.
inline double difference(std::uint32_t pixel, const Color& color) {
    return std::abs((pixel >> 16 & 255) / 255.0 - color.r) + std::abs((pixel >> 8 & 255) / 255.0 - color.g) +
           std::abs((pixel & 255) / 255.0 - color.b);
}

inline long differing_pixels(const Image& a, const Image& b, const Box& within) {
    long count = 0;
    for (int y = int(within.y); y < int(within.bottom()); ++y)
        for (int x = int(within.x); x < int(within.right()); ++x) count += pixel_at(a, x, y) != pixel_at(b, x, y);
    return count;
}

}  // namespace beamcam::render
