// Small numerical tools of the mechanics: Gauss–Legendre quadrature on [0, L], spectral integration
// between its nodes, and a bracketing root finder. No physics.
//
// Sources: Golub & Welsch 1969 (nodes as zeros of P_n, found here by Newton's method), Chandrupatla
// 1997 (root finder), Trefethen "Spectral Methods in MATLAB" ch. 12 (quadrature by interpolation).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "sim/base/assert.hpp"

namespace beamcam::sim {

// Quadrature with n nodes, exact for polynomials up to degree 2n − 1.
struct Quadrature {
    Eigen::VectorXd x;  // nodes in (0, length), ascending [m]
    Eigen::VectorXd w;  // weights, sum = length [m]
};
Quadrature gauss_legendre(int n, double length);

// ∫₀ˣ of the interpolation polynomial through values at the Gauss nodes, for any x in [0, length].
class SpectralIntegral {
  public:
    SpectralIntegral() = default;
    explicit SpectralIntegral(const Quadrature& nodes, double length);
    // weights[k] = ∫₀ˣ ℓ_k dξ; `weights` has one entry a node.
    void weights(double x, double* weights) const;
    // Row k: the weights of ∫ from 0 to node k.
    Eigen::MatrixXd matrix(const Quadrature& nodes) const;

  private:
    double length_ = 1;
    Eigen::MatrixXd legendre_;           // nodal values → Legendre coefficients of the interpolant, times length/2
    mutable Eigen::VectorXd primitive_;  // scratch: ∫ P_j
};

// Legendre polynomials P_0…P_{count−1} at z in [−1, 1].
void legendre(double z, int count, double* values);
// The same and their derivatives up to the order `orders` − 1, one order after the other.
void legendre(double z, int count, int orders, double* values);

// A root of f in [a, b], where f(a) and f(b) differ in sign or vanish; to the last bits.
// Chandrupatla's method: inverse quadratic interpolation where it is safe, else bisection. BENCHMARKS.md compares it.
template <class F>
double find_root(F&& f, double a, double b, double fa, double fb) {
    BEAMCAM_ASSERT(std::isfinite(a) && std::isfinite(b));
    BEAMCAM_ASSERT(fa == 0 || fb == 0 || std::signbit(fa) != std::signbit(fb));
    if (fa == 0) return a;
    if (fb == 0) return b;
    double c = a, fc = fa;
    double t = 0.5;
    for (int iteration = 0; iteration < 200; ++iteration) {
        const double x = a + t * (b - a);
        const double fx = f(x);
        if (std::signbit(fx) == std::signbit(fa)) {
            c = a;
            fc = fa;
        } else {
            c = b;
            b = a;
            fc = fb;
            fb = fa;
        }
        a = x;
        fa = fx;
        const double best = std::fabs(fa) < std::fabs(fb) ? a : b;
        const double width = std::fabs(b - a);
        const double eps = 2e-16 * std::fabs(best);
        if (width <= 2 * eps || fa == 0 || fb == 0) return fa == 0 ? a : (fb == 0 ? b : best);
        const double xi = (a - b) / (c - b), phi = (fa - fb) / (fc - fb);
        if (1 - std::sqrt(1 - xi) < phi && phi < std::sqrt(xi))
            t = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb);
        else
            t = 0.5;
        const double edge = eps / width;
        t = std::fmin(1 - edge, std::fmax(edge, t));
    }
    return std::fabs(fa) < std::fabs(fb) ? a : b;
}

template <class F>
double find_root(F&& f, double a, double b) {
    const double fa = f(a), fb = f(b);
    return find_root(std::forward<F>(f), a, b, fa, fb);
}

}  // namespace beamcam::sim
