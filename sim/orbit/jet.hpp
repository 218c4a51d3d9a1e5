// Numbers with eight directional derivatives (forward-mode automatic differentiation): a function of jets returns its
// value and its exact derivatives along eight tangents.
#pragma once

#include <cmath>
#include <vector>

#include "sim/base/lanes.hpp"

namespace beamcam::sim {

inline constexpr int kDirections = kNodes;

struct Jet {
    double v = 0;
    Lanes d{};  // derivative along each direction

    Jet() = default;
    Jet(double value) : v(value) {}  // a constant
    Jet(double value, const Lanes& derivatives) : v(value), d(derivatives) {}
};

inline Jet operator-(const Jet& a) { return {-a.v, -a.d}; }
inline Jet operator+(const Jet& a, const Jet& b) { return {a.v + b.v, a.d + b.d}; }
inline Jet operator-(const Jet& a, const Jet& b) { return {a.v - b.v, a.d - b.d}; }
inline Jet operator*(const Jet& a, const Jet& b) { return {a.v * b.v, a.d * b.v + b.d * a.v}; }
inline Jet operator/(const Jet& a, const Jet& b) {
    const double q = a.v / b.v;
    return {q, (a.d - b.d * q) / b.v};
}
inline Jet operator+(const Jet& a, double b) { return {a.v + b, a.d}; }
inline Jet operator-(const Jet& a, double b) { return {a.v - b, a.d}; }
inline Jet operator*(const Jet& a, double b) { return {a.v * b, a.d * b}; }
inline Jet operator/(const Jet& a, double b) { return {a.v / b, a.d / b}; }
inline Jet operator+(double a, const Jet& b) { return b + a; }
inline Jet operator-(double a, const Jet& b) { return -b + a; }
inline Jet operator*(double a, const Jet& b) { return b * a; }
inline Jet& operator+=(Jet& a, const Jet& b) { return a = a + b; }
inline Jet& operator-=(Jet& a, const Jet& b) { return a = a - b; }

// f(a) from the values f and f′ there.
inline Jet chain(const Jet& a, double f, double slope) { return {f, a.d * slope}; }
inline Jet sin(const Jet& a) { return chain(a, std::sin(a.v), std::cos(a.v)); }
inline Jet cos(const Jet& a) { return chain(a, std::cos(a.v), -std::sin(a.v)); }
inline Jet sqrt(const Jet& a) {
    const double root = std::sqrt(a.v);
    return chain(a, root, 0.5 / root);
}
inline Jet tanh(const Jet& a) {
    const double t = std::tanh(a.v);
    return chain(a, t, 1 - t * t);
}

inline Jet fabs(const Jet& a) { return a.v < 0 ? -a : a; }

// Comparisons use the values only.
inline bool isfinite(const Jet& a) { return std::isfinite(a.v); }
inline bool operator<(const Jet& a, const Jet& b) { return a.v < b.v; }
inline bool operator>(const Jet& a, const Jet& b) { return a.v > b.v; }
inline bool operator<=(const Jet& a, const Jet& b) { return a.v <= b.v; }
inline bool operator>=(const Jet& a, const Jet& b) { return a.v >= b.v; }
inline bool operator==(const Jet& a, const Jet& b) { return a.v == b.v; }

// Jets with int indices, as coordinates have.
class JetVector {
  public:
    explicit JetVector(int size = 0) : jets_(static_cast<std::size_t>(size)) {}
    int size() const { return static_cast<int>(jets_.size()); }
    Jet& operator[](int i) { return jets_[static_cast<std::size_t>(i)]; }
    const Jet& operator[](int i) const { return jets_[static_cast<std::size_t>(i)]; }

  private:
    std::vector<Jet> jets_;
};

// A vector of the plane.
struct Jet2 {
    Jet x, y;
};
inline Jet2 operator+(const Jet2& a, const Jet2& b) { return {a.x + b.x, a.y + b.y}; }
inline Jet2 operator-(const Jet2& a, const Jet2& b) { return {a.x - b.x, a.y - b.y}; }
inline Jet2 operator*(const Jet& s, const Jet2& a) { return {s * a.x, s * a.y}; }
inline Jet dot(const Jet2& a, const Jet2& b) { return a.x * b.x + a.y * b.y; }
inline Jet cross(const Jet2& a, const Jet2& b) { return a.x * b.y - a.y * b.x; }

}  // namespace beamcam::sim
