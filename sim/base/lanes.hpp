// Eight numbers side by side, one for each node of a collocation step, in the compiler's vector types of the width that
// every machine has (wider ones would be split through memory). Every lane sees the same operations in the same order,
// so results have the same bits on every machine.
#pragma once

#include <cmath>
#include <cstddef>

#define BEAMCAM_INLINE inline __attribute__((always_inline))

namespace beamcam::sim {

inline constexpr int kNodes = 8;

struct Lanes {
    using Part = double __attribute__((vector_size(16), may_alias));
    static constexpr int kParts = kNodes / 2;
    Part part[kParts];

    BEAMCAM_INLINE double& operator[](int k) { return reinterpret_cast<double*>(part)[k]; }
    BEAMCAM_INLINE double operator[](int k) const { return reinterpret_cast<const double*>(part)[k]; }
};

// Lane by lane; a number is the same in all lanes.
#define BEAMCAM_LANES_OPERATOR(op)                                                   \
    BEAMCAM_INLINE Lanes& operator op##=(Lanes& a, const Lanes& b) {                 \
        for (int i = 0; i < Lanes::kParts; ++i) a.part[i] = a.part[i] op b.part[i];  \
        return a;                                                                    \
    }                                                                                \
    BEAMCAM_INLINE Lanes& operator op##=(Lanes& a, double b) {                       \
        for (Lanes::Part & part : a.part) part = part op b;                          \
        return a;                                                                    \
    }                                                                                \
    BEAMCAM_INLINE Lanes operator op(Lanes a, const Lanes& b) { return a op## = b; } \
    BEAMCAM_INLINE Lanes operator op(Lanes a, double b) { return a op## = b; }       \
    BEAMCAM_INLINE Lanes operator op(double a, Lanes b) {                            \
        for (Lanes::Part & part : b.part) part = a op part;                          \
        return b;                                                                    \
    }
BEAMCAM_LANES_OPERATOR(+)
BEAMCAM_LANES_OPERATOR(-)
BEAMCAM_LANES_OPERATOR(*)
BEAMCAM_LANES_OPERATOR(/)
#undef BEAMCAM_LANES_OPERATOR
BEAMCAM_INLINE Lanes operator-(Lanes a) {
    for (Lanes::Part& part : a.part) part = -part;
    return a;
}

BEAMCAM_INLINE double sum(const Lanes& a) { return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7])); }
// The largest magnitude; NaN is passed over.
BEAMCAM_INLINE double largest(const Lanes& a) {
    Lanes::Part m{};
    for (const Lanes::Part& part : a.part) {
        m = part > m ? part : m;
        m = -part > m ? -part : m;
    }
    return m[0] > m[1] ? m[0] : m[1];
}

// y_r = Σ_c a[r·columns + c] x_c. Two rows share each load of x.
inline void product(std::size_t rows, std::size_t columns, const double* a, const Lanes* x, Lanes* y) {
    std::size_t r = 0;
    for (; r + 2 <= rows; r += 2) {
        const double *row = a + r * columns, *next = row + columns;
        Lanes total{}, next_total{};
        for (std::size_t c = 0; c < columns; ++c) {
            total += row[c] * x[c];
            next_total += next[c] * x[c];
        }
        y[r] = total;
        y[r + 1] = next_total;
    }
    if (r == rows) return;
    Lanes total{};
    for (std::size_t c = 0; c < columns; ++c) total += a[r * columns + c] * x[c];
    y[r] = total;
}

inline void sine_and_cosine(double a, double& sine, double& cosine) {
    sine = std::sin(a);
    cosine = std::cos(a);
}
// Taylor's series, to rounding for |a| <= kSeriesAngle.
inline constexpr double kSeriesAngle = 0.8;  // [rad] a little more than π/4
BEAMCAM_INLINE void sine_and_cosine_by_series(const Lanes& a, Lanes& sine, Lanes& cosine) {
    const Lanes a2 = a * a;
    Lanes s = a2 * (-1.0 / 1307674368000) + 1.0 / 6227020800, c = a2 * (1.0 / 20922789888000) - 1.0 / 87178291200;
    for (const double f : {-1.0 / 39916800, 1.0 / 362880, -1.0 / 5040, 1.0 / 120, -1.0 / 6}) s = s * a2 + f;
    for (const double f : {1.0 / 479001600, -1.0 / 3628800, 1.0 / 40320, -1.0 / 720, 1.0 / 24}) c = c * a2 + f;
    sine = a + a * (a2 * s);
    cosine = (1 - 0.5 * a2) + a2 * (a2 * c);
}
inline void sine_and_cosine(const Lanes& a, Lanes& sine, Lanes& cosine) {
    if (largest(a) <= kSeriesAngle) return sine_and_cosine_by_series(a, sine, cosine);
    for (int k = 0; k < kNodes; ++k) {
        sine[k] = std::sin(a[k]);
        cosine[k] = std::cos(a[k]);
    }
}
// Sine and cosine of small angles are exact to rounding up to kSmallRotation.
inline constexpr double kSmallRotation = 0.01;  // [rad]
inline void small_sine_and_cosine(const Lanes& a, Lanes& sine, Lanes& cosine) {
    if (!(largest(a) < kSmallRotation)) return sine_and_cosine(a, sine, cosine);
    const Lanes a2 = a * a;
    cosine = 1 - a2 * (0.5 - a2 * (1.0 / 24));
    sine = a * (1 - a2 * (1.0 / 6 - a2 * (1.0 / 120)));
}

}  // namespace beamcam::sim
