// BEAMCAM_ASSERT(condition): a precondition of the numerical core. Checked where the build has BEAMCAM_CHECKS on (the
// presets for development and sanitizers); otherwise the condition is not evaluated.
#pragma once

#ifdef BEAMCAM_CHECKS
#include <cstdio>
#include <cstdlib>

namespace beamcam::sim {

[[noreturn]] inline void precondition_failed(const char* condition, const char* file, int line) {
    std::fprintf(stderr, "%s:%d: precondition violated: %s\n", file, line, condition);
    std::abort();
}

}  // namespace beamcam::sim

#define BEAMCAM_ASSERT(condition) \
    ((condition) ? void() : ::beamcam::sim::precondition_failed(#condition, __FILE__, __LINE__))
#else
#define BEAMCAM_ASSERT(condition) static_cast<void>(sizeof(!(condition)))
#endif
