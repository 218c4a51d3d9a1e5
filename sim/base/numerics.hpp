// Small numerical tools of the mechanics: Gauss–Legendre quadrature on [0, L], spectral integration
// between its nodes, bracketing root finders, and the maximum of a function. No physics.
//
// Sources: Golub & Welsch 1969 (nodes as zeros of P_n, found here by Newton's method), Chandrupatla
// 1997 (root finder), Trefethen "Spectral Methods in MATLAB" ch. 12 (quadrature by interpolation).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "sim/base/assert.hpp"
#include "sim/base/vec2.hpp"

namespace beamcam::sim {

// Shares of the size of a quantity below which a difference is the rounding of one operation on it or of a long
// computation, or shows in no result. A step of Newton's method that is negligible leaves an error of its square.
inline constexpr double kRounding = 1e-14, kLongRounding = 1e-12, kNegligible = 1e-9;

// Iterations of Newton's method, with bisection as a safeguard: bisection alone needs 52.
inline constexpr int kMostIterations = 60;

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
// These polynomials and their derivatives up to the order `orders` − 1, one order after the other.
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

// The root of an increasing function in [low, high] by Newton's method, else by bisection. f(x) returns its value and
// its slope. Without a root the end that is nearest to one.
template <class F>
double increasing_root(F&& f, double low, double high) {
    double x = 0.5 * (low + high);
    for (int i = 0; i < kMostIterations; ++i) {
        const auto [value, slope] = f(x);
        (value > 0 ? high : low) = x;
        double next = x - value / slope;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        const double change = std::fabs(next - x);
        x = next;
        if (change <= 2e-16 * std::fabs(x)) break;
    }
    return x;
}

// The top of the parabola through three points in the order of x; nothing if it has none between the first and the
// last.
inline std::optional<Vec2> vertex(const Vec2& a, const Vec2& b, const Vec2& c) {
    const double left = (b.y - a.y) / (b.x - a.x), right = (c.y - b.y) / (c.x - b.x);
    const double bend = (right - left) / (c.x - a.x);
    if (!(bend < 0)) return std::nullopt;
    const double x = 0.5 * (a.x + b.x) - 0.5 * left / bend;
    if (!(x >= a.x && x <= c.x)) return std::nullopt;
    return Vec2{x, a.y + (x - a.x) * (left + bend * (x - b.x))};
}

// A function may rise above its parabola by this share of the parabola's rise above the points through which it passes.
// The share is 0.12 for a vibration with eight points in a period.
inline constexpr double kParabolaError = 0.25;

// Of a function's range: a maximum that is higher by less is not searched for.
inline constexpr double kNegligibleRise = 1e-6;

// The largest value of f by parabolas, one after the other, from three points of f in the order of x. Ends earlier
// where the parabola does not promise `negligible` more than `to_beat`.
template <class F>
Vec2 climb(F&& f, Vec2 a, Vec2 b, Vec2 c, double to_beat, double negligible) {
    constexpr int kMostParabolas = 10;   // each squares the distance from the maximum, but for the first
    constexpr double kConverged = 1e-3;  // of what is negligible
    Vec2 best = std::max({a, b, c}, [](const Vec2& p, const Vec2& q) { return p.y < q.y; });
    for (int i = 0; i < kMostParabolas; ++i) {
        const auto top = vertex(a, b, c);
        if (!top) return best;
        const double rise = top->y - best.y;
        if (!(top->y + kParabolaError * rise > to_beat + negligible) || !(rise > kConverged * negligible)) return best;
        const Vec2 next{top->x, f(top->x)};
        if (next.x == b.x || !std::isfinite(next.y)) return best;
        if (next.y > best.y) best = next;
        const bool before = next.x < b.x;
        if (next.y > b.y)
            (before ? c : a) = std::exchange(b, next);
        else
            (before ? a : c) = next;
    }
    return best;
}

// Where f is largest over intervals with these increasing ends, inside each of which it is smooth: {x, f(x)}. At an end
// both limits count.
template <class F>
Vec2 largest_over(const std::vector<double>& ends, F&& f) {
    constexpr int kSamples = 8;    // in an interval
    constexpr int kHalvings = 20;  // of the part between an end and the next sample
    Vec2 best{ends.front(), -std::numeric_limits<double>::infinity()};
    const auto keep = [&best](const Vec2& at) {
        if (at.y > best.y) best = at;
    };
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double width = (ends[i + 1] - ends[i]) * (1 - kLongRounding);
        std::array<Vec2, kSamples + 1> samples;
        for (std::size_t k = 0; k <= kSamples; ++k) {
            const double x = ends[i] + width * static_cast<double>(k) / kSamples;
            keep(samples[k] = {x, f(x)});
        }
        const auto refine = [&](const Vec2& a, const Vec2& b, const Vec2& c) {
            keep(climb([&f](double x) { return f(x); }, a, b, c, best.y, 0));
        };
        for (std::size_t k = 1; k < kSamples; ++k)
            if (samples[k].y >= samples[k - 1].y && samples[k].y >= samples[k + 1].y)
                refine(samples[k - 1], samples[k], samples[k + 1]);
        // The maximum may be nearer to an end than the last sample but one.
        for (const auto& [end, inner] :
             {std::pair{samples[0], samples[1]}, std::pair{samples[kSamples], samples[kSamples - 1]}}) {
            Vec2 between = inner;
            for (int k = 0; k < kHalvings && between.y < end.y; ++k) {
                const double x = 0.5 * (between.x + end.x);
                const Vec2 before = std::exchange(between, Vec2{x, f(x)});
                if (between.y < end.y) continue;
                if (end.x < before.x)
                    refine(end, between, before);
                else
                    refine(before, between, end);
            }
        }
    }
    return best;
}

}  // namespace beamcam::sim
