// Eight numbers side by side, one for each node of a collocation step. Written with the compiler's vector
// types: every lane sees the same operations in the same order whatever the machine, so results have the same bits
// with two, four or eight lanes an instruction.
#pragma once

#include <cmath>

#define BEAMCAM_INLINE inline __attribute__((always_inline))

namespace beamcam::sim {

inline constexpr int kNodes = 8;
using Lanes = double __attribute__((vector_size(kNodes * sizeof(double))));

BEAMCAM_INLINE void spread(double value, Lanes& out) { out = Lanes{} + value; }
BEAMCAM_INLINE double sum(const Lanes& a) {
    return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7]));
}
BEAMCAM_INLINE double largest(const Lanes& a) {
    double m = 0;
    for (int k = 0; k < kNodes; ++k) m = a[k] > m ? a[k] : (-a[k] > m ? -a[k] : m);
    return m;
}

}  // namespace beamcam::sim
