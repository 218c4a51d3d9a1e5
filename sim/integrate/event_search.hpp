// Events inside a step: where a smooth function of time falls through zero, or its rate passes a level, however
// briefly.
//
// Between two instants with value and rate the function is the cubic through them and an error E s²(1 − s)², E its
// largest second difference: more than the error of any vibration that turns by up to two radians in between. In
// Bernstein coefficients of degree four only the middle one is then uncertain. A polynomial lies within the hull of its
// coefficients and has no more zeros than they change sign: either this decides, or the interval is halved and the
// function evaluated in the middle. Faster vibration enters as a `Ripple`. MODEL.md (S58).
//
// Source: Farin, "Curves and Surfaces for CAGD", ch. 5 (convex hull and variation diminishing property).
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/base/assert.hpp"
#include "sim/base/numerics.hpp"

namespace beamcam::sim {

inline constexpr double kOnKink = 1e-6;        // of an interval: a passing so early means that it starts on the kink
inline constexpr int kMostEventHalvings = 16;  // then the ends decide: 10⁻⁵ of the interval

// A function of time and its rate.
struct Guard {
    double t = 0, value = 0, rate = 0;
};

// Bounds of the distance of value and rate from a smooth interpolation.
struct Ripple {
    double value = 0, rate = 0;
};
// For functions that the instants resolve, however far apart.
struct NoRipple {
    Ripple operator()(double /*span*/) const { return {}; }
};

namespace event_search {

constexpr double kErrorShare = 1.0 / 6;  // of E that the middle coefficient of s²(1 − s)² has

// The value and, in four coefficients, the rate between two guards.
struct Quartic {
    double c[5], error, ripple, span, rate_error;
    Quartic(const Guard& a, const Guard& b, const Ripple& more) : ripple(more.value), span(b.t - a.t) {
        const double b1 = a.value + a.rate * span / 3, b2 = b.value - b.rate * span / 3;
        c[0] = a.value;
        c[1] = 0.25 * (a.value + 3 * b1);
        c[2] = 0.5 * (b1 + b2);
        c[3] = 0.25 * (3 * b2 + b.value);
        c[4] = b.value;
        error = kErrorShare * std::max(std::fabs(a.value - 2 * b1 + b2), std::fabs(b1 - 2 * b2 + b.value));
        rate_error = 4 * error / span + more.rate;
        error += ripple;
    }
    double rate(int i) const { return 4 * (c[i + 1] - c[i]) / span; }
    // All of value + shift is positive; it falls through zero once, from a positive start to a negative end.
    bool positive(double shift) const {
        return c[0] + shift >= 0 && c[1] + shift > ripple && c[2] + shift > error && c[3] + shift > ripple &&
               c[4] + shift >= 0;
    }
    // All of the rate, but perhaps at its start, stays on this side of the level.
    bool keeps_side(double level, double side, double none) const {
        const double least = std::min(side * (rate(1) - level), side * (rate(2) - level)) - rate_error;
        return least > -none && side * (rate(3) - level) >= -none;
    }
    bool falls_once(double shift) const {
        if (!(c[0] + shift >= 0 && c[4] + shift < 0 && ripple == 0)) return false;
        if (c[1] + shift > 0) return c[3] + shift < 0 || c[2] + shift > error;
        return c[3] + shift < 0 && c[2] + shift < -error;
    }
};

struct Bracket {
    Guard above, below;
};

// The first bracket between a and b with a value below −deep at its end.
template <class Probe, class RippleOf>
std::optional<Bracket> first_dip(Probe& probe, const Guard& a, const Guard& b, double deep, RippleOf& ripple,
                                 int halvings) {
    const Quartic q(a, b, ripple(b.t - a.t));
    if (q.positive(deep)) return std::nullopt;
    const bool below = b.value < -deep;
    const double t = a.t + 0.5 * q.span;
    if ((below && q.falls_once(deep)) || halvings == kMostEventHalvings || !(t > a.t && t < b.t))
        return below ? std::optional(Bracket{a, b}) : std::nullopt;
    const Guard middle = probe(t);
    if (const auto found = first_dip(probe, a, middle, deep, ripple, halvings + 1)) return found;
    return first_dip(probe, middle, b, deep, ripple, halvings + 1);
}

}  // namespace event_search

// The first instant in (a, b] where the guard falls through zero; `probe(t)` gives a Guard. At a it is positive, or
// zero and leaves it first, or falls at once. A dip between the ends that is no deeper than `deep` is rounding.
template <class Probe, class RippleOf = NoRipple>
std::optional<double> first_fall(Probe&& probe, const Guard& a, const Guard& b, double deep = 0, RippleOf ripple = {}) {
    using namespace event_search;
    BEAMCAM_ASSERT(a.t < b.t && deep >= 0);
    if (a.value < 0 || (a.value == 0 && a.rate < 0)) return a.t;
    Bracket bracket{a, b};
    const Quartic q(a, b, ripple(b.t - a.t));
    if (!(b.value < 0) && q.positive(0)) return std::nullopt;
    if (!(b.value < 0) || !q.falls_once(0)) {
        if (const auto found = first_dip(probe, a, b, deep, ripple, 0))
            bracket = *found;
        else if (!(b.value < 0))
            return std::nullopt;
    }
    const auto value = [&](double t) { return probe(t).value; };
    const auto& [above, below] = bracket;
    if (above.value > 0) return find_root(value, above.t, below.t, above.value, below.value);
    // It starts on the surface: leaves it first, or falls at once.
    if (!(above.rate > 0) || !(below.rate < 0)) return above.rate > 0 ? below.t : above.t;
    const double top = find_root([&](double t) { return probe(t).rate; }, above.t, below.t, above.rate, below.rate);
    const double highest = value(top);
    if (!(highest > 0)) return above.t;
    return find_root(value, top, below.t, highest, below.value);
}

// The first instant in (a, b] where the rate passes `level`; `side` is the sign of rate − level before. Differences up
// to `none` from the level have no side: a search that starts there begins where the rate leaves it. Where the value
// departs from a line by no more than its `rounding`, the ends decide.
template <class Probe, class RippleOf = NoRipple>
std::optional<double> first_passing(Probe&& probe, const Guard& a, const Guard& b, double level, double side,
                                    double none, double rounding, RippleOf ripple = {}, int halvings = 0) {
    using namespace event_search;
    BEAMCAM_ASSERT(a.t < b.t && std::fabs(side) == 1 && none >= 0);
    const auto over = [&](double rate) { return side * (rate - level); };
    const Quartic q(a, b, ripple(b.t - a.t));
    const double d0 = over(a.rate), d1 = over(q.rate(1)), d2 = over(q.rate(2)), d3 = over(b.rate);
    if (q.keeps_side(level, side, none)) return std::nullopt;
    const bool beyond = d3 < -none;
    const double t = a.t + 0.5 * q.span;
    if (beyond && d0 > none && (d1 > q.rate_error || d2 < -q.rate_error))
        return find_root([&](double at) { return over(probe(at).rate); }, a.t, b.t, d0, d3);
    if (q.error <= rounding || halvings == kMostEventHalvings || !(t > a.t && t < b.t))
        return beyond ? std::optional(b.t) : std::nullopt;
    const Guard middle = probe(t);
    if (const auto found = first_passing(probe, a, middle, level, side, none, rounding, ripple, halvings + 1))
        return found;
    return first_passing(probe, middle, b, level, side, none, rounding, ripple, halvings + 1);
}

}  // namespace beamcam::sim
