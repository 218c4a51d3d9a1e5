// Numbers with derivatives (forward-mode automatic differentiation): a function of them returns its value and its exact
// derivatives.
#pragma once

#include <cmath>

#include "sim/base/lanes.hpp"

namespace beamcam::sim {

template <class V>
consteval int derivatives_of() {
    if constexpr (requires { V::kDerivatives; })
        return V::kDerivatives;
    else
        return 0;
}

inline double value_of(double a) { return a; }

// A value and its derivatives, each a number of type V or several of them side by side.
template <class V, class D>
struct Dual {
    static constexpr int kDerivatives = 1 + derivatives_of<V>();  // how often it is differentiated
    V v{};
    D d{};

    Dual() = default;
    Dual(double value) : v(value) {}  // a constant
    Dual(const V& value, const D& derivatives) : v(value), d(derivatives) {}

    friend Dual operator-(const Dual& a) { return {-a.v, -a.d}; }
    friend Dual operator+(const Dual& a, const Dual& b) { return {a.v + b.v, a.d + b.d}; }
    friend Dual operator-(const Dual& a, const Dual& b) { return {a.v - b.v, a.d - b.d}; }
    friend Dual operator*(const Dual& a, const Dual& b) { return {a.v * b.v, a.d * b.v + b.d * a.v}; }
    friend Dual operator/(const Dual& a, const Dual& b) {
        const V q = a.v / b.v;
        return {q, (a.d - b.d * q) / b.v};
    }
    friend Dual operator+(const Dual& a, double b) { return {a.v + b, a.d}; }
    friend Dual operator-(const Dual& a, double b) { return {a.v - b, a.d}; }
    friend Dual operator*(const Dual& a, double b) { return {a.v * b, a.d * b}; }
    friend Dual operator/(const Dual& a, double b) { return {a.v / b, a.d / b}; }
    friend Dual operator+(double a, const Dual& b) { return b + a; }
    friend Dual operator-(double a, const Dual& b) { return -b + a; }
    friend Dual operator*(double a, const Dual& b) { return b * a; }
    Dual& operator+=(const Dual& b) { return *this = *this + b; }
    Dual& operator-=(const Dual& b) { return *this = *this - b; }

    // f(a) from the values f and f′ there.
    friend Dual chain(const Dual& a, const V& f, const V& slope) { return {f, a.d * slope}; }
    friend Dual sin(const Dual& a) {
        using std::sin, std::cos;
        return chain(a, sin(a.v), cos(a.v));
    }
    friend Dual cos(const Dual& a) {
        using std::sin, std::cos;
        return chain(a, cos(a.v), -sin(a.v));
    }
    friend Dual sqrt(const Dual& a) {
        using std::sqrt;
        const V root = sqrt(a.v);
        return chain(a, root, 0.5 / root);
    }
    friend Dual tanh(const Dual& a) {
        using std::tanh;
        const V t = tanh(a.v);
        return chain(a, t, 1.0 - t * t);
    }
    friend Dual fabs(const Dual& a) { return a.v < 0 ? -a : a; }

    // Comparisons use the values only.
    friend bool isfinite(const Dual& a) { return std::isfinite(a.v); }
    friend bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
    friend bool operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
    friend bool operator<=(const Dual& a, const Dual& b) { return a.v <= b.v; }
    friend bool operator>=(const Dual& a, const Dual& b) { return a.v >= b.v; }
    friend bool operator==(const Dual& a, const Dual& b) { return a.v == b.v; }

    // The functions of contact_lanes.hpp.
    friend double value_of(const Dual& a) { return value_of(a.v); }
    friend double sign_of(const Dual& a) { return value_of(a) < 0 ? -1 : 1; }
    friend void direction(const Dual& x, const Dual& y, Dual& out) {
        direction(x.v, y.v, out.v);
        out.d = (x.v * y.d - y.v * x.d) / (x.v * x.v + y.v * y.v);
    }
    friend void root(const Dual& a, Dual& out) { out = sqrt(a); }
    friend void sine_and_cosine(const Dual& a, Dual& sine, Dual& cosine) {
        sine = sin(a);
        cosine = cos(a);
    }
};

// Derivatives along eight directions.
inline constexpr int kDirections = kNodes;
using Jet = Dual<double, Lanes>;
// A jet that depends on time, and its time derivative.
using JetRate = Dual<Jet, Jet>;

}  // namespace beamcam::sim
