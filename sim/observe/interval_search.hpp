// Searches within one interval, for a function whose variation is bounded: its largest value and its changes of sign.
// Branch and bound by halving, then parabolas.                                                              (S59)
#pragma once

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "sim/observe/constants.hpp"
#include "sim/observe/undamped_mode.hpp"
#include "sim/observe/variation.hpp"

namespace beamcam::sim {

struct TimedValue {
    double t, value;
};

// The largest value of sign · f so far.
struct BestValue {
    double sign, value, t;
    double left_out;     // a rise that is negligible
    long intervals = 0;  // that the search may still halve
    void offer(const TimedValue& s) {
        if (!(sign * s.value > value)) return;
        value = sign * s.value;
        t = s.t;
    }
    double to_beat() const { return value + left_out; }
};

// The maximum of sign · f near three samples, if the parabola through them exceeds the best value.
template <class F>
void climb_crest(const F& f, const Variation& variation, TimedValue a, TimedValue m, TimedValue b, BestValue& best) {
    double error = variation.parabola_error(b.t - a.t);
    for (int round = 0; round < kMostParabolas; ++round) {
        const double left = best.sign * (m.value - a.value) / (m.t - a.t),
                     right = best.sign * (b.value - m.value) / (b.t - m.t), bend = (left - right) / (b.t - a.t);
        const double slope = (left * (b.t - m.t) + right * (m.t - a.t)) / (b.t - a.t);  // at m
        if (!(bend > 0)) return;
        const double margin = kParabolaMargin * (b.t - a.t), step = 0.5 * slope / bend;
        if (!(best.sign * m.value + 0.25 * slope * slope / bend + error > best.to_beat())) return;
        const double t = std::clamp(m.t + step, a.t + margin, b.t - margin);
        if (std::fabs(t - m.t) < kParabolaConverged * (b.t - a.t)) return;
        const TimedValue next{t, f(t)};
        best.offer(next);
        const TimedValue first = t < m.t ? next : m, second = t < m.t ? m : next;
        if (best.sign * first.value > best.sign * second.value)
            std::tie(m, b) = std::pair{first, second};
        else
            std::tie(a, m) = std::pair{first, second};
        error = std::min(error, variation.parabola_error(b.t - a.t));
    }
}

template <class F>
void climb(const F& f, const Variation& variation, const TimedValue& a, const TimedValue& b, BestValue& best) {
    const double length = b.t - a.t, t = a.t + 0.5 * length;
    const double high = std::max(best.sign * a.value, best.sign * b.value);
    if (!(high + variation.rises(length, a.value - b.value) > best.to_beat()) || !(t > a.t && t < b.t)) return;
    if (--best.intervals < 0) return;
    const TimedValue m{t, f(t)};
    best.offer(m);
    if (variation.unresolved(length) <= best.left_out) {
        climb_crest(f, variation, a, m, b, best);
        return;
    }
    const bool left_first = best.sign * a.value > best.sign * b.value;
    if (left_first) climb(f, variation, a, m, best);
    climb(f, variation, m, b, best);
    if (!left_first) climb(f, variation, a, m, best);
}

// Where the function is an undamped mode, only the crests that exceed the best value are searched.
template <class F>
void climb_crests(const F& f, const Variation& variation, const UndampedMode& mode, double from, double to,
                  BestValue& best) {
    mode.each_crest(best.sign, from, to, [&](double a, double b, double high) {
        if (!(high > best.to_beat())) return;
        const TimedValue first{a, f(a)}, last{b, f(b)};
        best.offer(first);
        best.offer(last);
        climb(f, variation, first, last, best);
    });
}

// Calls found(a, b) for intervals, in order, in which f changes its sign once. Values below `rounding` have no sign.
template <class F, class Found>
void sign_changes(const F& f, const Variation& variation, double rounding, const TimedValue& a, const TimedValue& b,
                  const Found& found) {
    const double length = b.t - a.t, stray = variation.strays(length), t = a.t + 0.5 * length;
    if (std::min(a.value, b.value) > stray || std::max(a.value, b.value) < -stray) return;
    const bool monotone = std::fabs(b.value - a.value) > length * variation.slope_strays(length);
    if (monotone || stray <= rounding || !(t > a.t && t < b.t)) {
        // Where the beam bends beyond its model, a step may have an end but no values within.
        if (std::isfinite(a.value) && std::isfinite(b.value) && (a.value > 0) != (b.value > 0)) found(a, b);
        return;
    }
    const TimedValue m{t, f(t)};
    sign_changes(f, variation, rounding, a, m, found);
    sign_changes(f, variation, rounding, m, b, found);
}

}  // namespace beamcam::sim
