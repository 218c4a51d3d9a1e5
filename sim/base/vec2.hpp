// A point or vector of the plane, [m] unless said otherwise. X to the right, Y up.
#pragma once

#include <cmath>

namespace beamcam::sim {

struct Vec2 {
    double x = 0, y = 0;

    constexpr Vec2 operator+(Vec2 o) const { return {x + o.x, y + o.y}; }
    constexpr Vec2 operator-(Vec2 o) const { return {x - o.x, y - o.y}; }
    constexpr Vec2 operator-() const { return {-x, -y}; }
    constexpr Vec2 operator*(double s) const { return {x * s, y * s}; }
    constexpr Vec2& operator+=(Vec2 o) {
        x += o.x;
        y += o.y;
        return *this;
    }
    constexpr bool operator==(const Vec2&) const = default;
};
constexpr Vec2 operator*(double s, Vec2 v) { return {s * v.x, s * v.y}; }
constexpr double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
constexpr double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
constexpr Vec2 perp(Vec2 v) { return {-v.y, v.x}; }  // turned by +90°
inline double norm(Vec2 v) { return std::hypot(v.x, v.y); }
inline Vec2 unit(double angle) { return {std::cos(angle), std::sin(angle)}; }

}  // namespace beamcam::sim
