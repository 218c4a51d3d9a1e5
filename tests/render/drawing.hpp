// Helpers for tests of films.
#pragma once

#include <gtest/gtest.h>

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

inline long differing_pixels(const Image& a, const Image& b, const Box& within) {
    long count = 0;
    for (int y = int(within.y); y < int(within.bottom()); ++y)
        for (int x = int(within.x); x < int(within.right()); ++x) {
            const std::size_t i = std::size_t(y) * std::size_t(a.width) + std::size_t(x);
            count += a.pixels[i] != b.pixels[i];
        }
    return count;
}

}  // namespace beamcam::render
