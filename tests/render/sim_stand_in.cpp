// Derived quantities of sim/problem.hpp for builds in which sim does not define them yet; weak, so that sim's win.
#include "sim/problem.hpp"

namespace beamcam::sim {
__attribute__((weak)) double contact_offset(const Problem& problem) {
    return problem.contact.offset.value_or(problem.beam.depth / 2);
}
__attribute__((weak)) double contact_stiffness(const Problem& problem) {
    return problem.contact.stiffness.value_or(1.6e10);
}
}  // namespace beamcam::sim
