#include "render/draw/smooth_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace beamcam::render {
namespace {

constexpr double kMostSteps = 64;
constexpr double kMostTurningSteps = 4096;  // several turns in a large picture; more turns look like a ring
constexpr double kSame = 1e-9;              // [px]

// The next point that differs from points[i], in direction `way` (±1).
std::optional<Vec2> beyond(std::span<const Vec2> points, std::size_t i, int way) {
    for (auto k = static_cast<std::ptrdiff_t>(i) + way; k >= 0 && k < std::ssize(points); k += way)
        if (norm(points[static_cast<std::size_t>(k)] - points[i]) > kSame) return points[static_cast<std::size_t>(k)];
    return std::nullopt;
}

// p reflected at the bisector of b and c: continues an arc b, c, p backwards.
Vec2 mirrored(Vec2 p, Vec2 b, Vec2 c) {
    const Vec2 along = (c - b) * (1 / norm(c - b));
    return p - along * (2 * dot(along, p - (b + c) * 0.5));
}

// Linear interpolation or extrapolation between a at t0 and b at t1.
Vec2 blend(Vec2 a, Vec2 b, double t0, double t1, double t) {
    return a * ((t1 - t) / (t1 - t0)) + b * ((t - t0) / (t1 - t0));
}

}  // namespace

std::vector<Vec2> smooth_piece(std::span<const Vec2> points, std::size_t i, double step) {
    const Vec2 b = points[i], c = points[i + 1];
    const double length = norm(c - b);
    if (!(length > step)) return {b, c};
    const std::optional<Vec2> before = beyond(points, i, -1), after = beyond(points, i + 1, +1);
    if (!before && !after) return {b, c};
    const Vec2 a = before ? *before : mirrored(*after, b, c), d = after ? *after : mirrored(*before, b, c);
    // Knots by the square roots of the distances; Barry and Goldman's recursion.
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

std::vector<Vec2> turning_piece(Vec2 centre, Vec2 from, Vec2 to, double turn, double step) {
    const Vec2 first = from - centre, last = to - centre;
    const double start = std::atan2(-first.y, first.x), end = std::atan2(-last.y, last.x);
    // The positions give the angle up to whole turns.
    const double angle = turn + std::remainder(end - start - turn, 2 * std::numbers::pi);
    const double length = std::abs(angle) * std::max(norm(first), norm(last));
    const int steps = std::max(1, static_cast<int>(std::min(std::ceil(length / step), kMostTurningSteps)));
    std::vector<Vec2> out{from};
    for (int k = 1; k < steps; ++k) {
        const double part = double(k) / steps, at = start + part * angle;
        const double distance = norm(first) + part * (norm(last) - norm(first));
        out.push_back(centre + Vec2{std::cos(at), -std::sin(at)} * distance);
    }
    out.push_back(to);
    return out;
}

}  // namespace beamcam::render
