// Tests that take long under a sanitizer.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>

namespace beamcam {

inline bool under_sanitizers() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return std::getenv("BEAMCAM_EVERY_TEST") == nullptr;  // tests/run --full sets it
#else
    return false;
#endif
}

}  // namespace beamcam

// For a test that takes more than some seconds under a sanitizer, and whose code shorter ones run too.
#define SKIP_UNDER_SANITIZERS()                                            \
    if (::beamcam::under_sanitizers())                                     \
    GTEST_SKIP() << "takes long under a sanitizer; tests/run --full runs " \
                    "it"
