// What the tests of drawn films share.
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

// Without those of Chinese.
inline const Fonts& fonts() {
    static const Fonts loaded(false);
    return loaded;
}

inline Image drawn(Film& film, int frame) {
    Image image;
    film.draw(frame, image);
    return image;
}

}  // namespace beamcam::render
