#include "render/draw/smooth_path.hpp"

#include <cmath>

namespace beamcam::render {
namespace {

constexpr double kMostSteps = 64;
constexpr double kSame = 1e-9;  // [px]

// The next point that differs from points[i], going by `way`; where there is none, i's neighbour mirrored at it.
Vec2 beyond(std::span<const Vec2> points, std::size_t i, int way, Vec2 neighbour) {
    for (auto k = static_cast<std::ptrdiff_t>(i) + way; k >= 0 && k < std::ssize(points); k += way)
        if (norm(points[static_cast<std::size_t>(k)] - points[i]) > kSame) return points[static_cast<std::size_t>(k)];
    return points[i] * 2 - neighbour;
}

// Between a at t0 and b at t1, or beyond.
Vec2 blend(Vec2 a, Vec2 b, double t0, double t1, double t) {
    return a * ((t1 - t) / (t1 - t0)) + b * ((t - t0) / (t1 - t0));
}

}  // namespace

std::vector<Vec2> smooth_piece(std::span<const Vec2> points, std::size_t i, double step) {
    const Vec2 b = points[i], c = points[i + 1];
    const double length = norm(c - b);
    if (!(length > step)) return {b, c};
    const Vec2 a = beyond(points, i, -1, c), d = beyond(points, i + 1, +1, b);
    // Knots at the square roots of the distances; Barry and Goldman's pyramid.
    const double t1 = std::sqrt(norm(b - a)), t2 = t1 + std::sqrt(length), t3 = t2 + std::sqrt(norm(d - c));
    const int steps = static_cast<int>(std::min(std::ceil(length / step), kMostSteps));
    std::vector<Vec2> out{b};
    for (int k = 1; k < steps; ++k) {
        const double t = t1 + (t2 - t1) * k / steps;
        const Vec2 ab = blend(a, b, 0, t1, t), bc = blend(b, c, t1, t2, t), cd = blend(c, d, t2, t3, t);
        out.push_back(blend(blend(ab, bc, 0, t2, t), blend(bc, cd, t1, t3, t), t1, t2, t));
    }
    out.push_back(c);
    return out;
}

}  // namespace beamcam::render
