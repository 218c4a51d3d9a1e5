// Impulsive contact with dry friction at one point: Routh's construction in the plane of impulses, terminated by
// Newton's, Poisson's or Stronge's law of restitution. MODEL.md §9. Templates, because tangents of the flow pass an
// impact in numbers that carry derivatives (orbit/jet.hpp).
//
// Sources: Routh 1860; Wang & Mason 1992; Stronge, "Impact Mechanics", 2000.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "sim/base/assert.hpp"
#include "sim/base/ode.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// Response of the contact point to impulses: Δv_n = nn P_n + nt P_t, Δv_t = nt P_n + tt P_t [1/kg].
template <class T>
struct ComplianceOf {
    T nn = 1, nt = 0, tt = 1;  // nn > 0, tt >= 0, nn·tt >= nt²
};

template <class T>
struct ImpactResultOf {
    T impulse_n = 0, impulse_t = 0;  // [N s]
    T v_n = 0, v_t = 0;              // after [m/s]
};

using Compliance = ComplianceOf<double>;
using ImpactResult = ImpactResultOf<double>;

namespace impulse {

inline constexpr double kForever = std::numeric_limits<double>::infinity();

// One straight segment of the path in the plane of impulses: dP_t = slope dP_n, over `length` of P_n.
template <class T>
struct PathSegment {
    T slope, length;
};

// Sliding until the slip vanishes; then sticking, or sliding in the other direction if friction cannot hold (S43).
template <class T>
std::array<PathSegment<T>, 2> impulse_path(const ComplianceOf<T>& c, const T& v_t, double mu) {
    using std::fabs;
    const T stick = -c.nt / c.tt;  // the slope that keeps v_t = 0
    const double direction = c.nt > 0 ? 1 : -1;
    const T after = fabs(stick) <= mu ? stick : T(-mu * direction);
    if (v_t == 0) return {{{after, T(kForever)}, {after, T(kForever)}}};
    const double sign = v_t > 0 ? 1 : -1, slope = -mu * sign;
    const T deceleration = -(c.nt + c.tt * slope) * sign;  // −d|v_t|/dP_n
    const T stops = deceleration > 0 ? fabs(v_t) / deceleration : T(kForever);
    return {{{T(slope), stops}, {after, T(kForever)}}};
}

// The state of an impact.
template <class T>
struct State {
    bool compressing = true;
    T impulse_n, v_n;                              // now
    T compression_impulse = 0;                     // of the whole compression
    T compression_work = 0, restitution_work = 0;  // ∫v_n dP_n, < 0 and > 0
};

// The impulse P_n to the end of compression or, after that, of restitution while dv_n/dP_n = rate. kForever: no end.
template <class T>
T remaining(const State<T>& now, const T& rate, const T& v_n_before, double restitution, ImpactLaw law) {
    using std::sqrt;
    if (now.compressing) return rate > 0 ? T(-now.v_n / rate) : T(kForever);
    if (law == ImpactLaw::newton) return rate > 0 ? T((-restitution * v_n_before - now.v_n) / rate) : T(kForever);
    if (law == ImpactLaw::poisson) return (1 + restitution) * now.compression_impulse - now.impulse_n;
    // Stronge: v_n s + ½ rate s² = the missing work of restitution.
    const T missing = -restitution * restitution * now.compression_work - now.restitution_work;
    const T root = now.v_n * now.v_n + 2 * rate * missing;
    if (!(root >= 0)) return T(kForever);
    return missing <= 0 ? T(0) : T(2 * missing / (now.v_n + sqrt(root)));
}

}  // namespace impulse

// v_n < 0 approaches. `friction` is μ >= 0, `restitution` in [0, 1]. Throws ContactLocked where no impulse ends
// the impact (jamming of a singular compliance).
template <class T>
ImpactResultOf<T> resolve_impact(const ComplianceOf<T>& c, const std::type_identity_t<T>& v_n,
                                 const std::type_identity_t<T>& v_t, double friction, double restitution,
                                 ImpactLaw law) {
    using std::isfinite;
    BEAMCAM_ASSERT(c.nn > 0 && c.tt >= 0 && friction >= 0);
    BEAMCAM_ASSERT(restitution >= 0 && restitution <= 1);
    ImpactResultOf<T> r{0, 0, v_n, v_t};
    if (!(v_n < 0)) return r;
    const std::array<impulse::PathSegment<T>, 2> path = impulse::impulse_path(c, v_t, friction);

    // Follow the path; v_n is linear in P_n on each segment. Compression ends where v_n passes zero.
    impulse::State<T> now{.impulse_n = 0, .v_n = v_n};
    for (std::size_t k = 0; k < path.size();) {
        const impulse::PathSegment<T>& segment = path[k];
        const T rate = c.nn + c.nt * segment.slope;  // dv_n/dP_n; negative while the contact jams
        T step = k == 0 ? T(segment.length - now.impulse_n) : T(impulse::kForever);
        const T end = impulse::remaining(now, rate, v_n, restitution, law);
        const bool ends = end <= step;
        if (ends) step = end > 0 ? end : T(0);
        // Never for a positive definite compliance.
        if (!isfinite(step)) throw ContactLocked();
        (now.compressing ? now.compression_work : now.restitution_work) += now.v_n * step + 0.5 * rate * step * step;
        now.impulse_n += step;
        now.v_n += rate * step;
        r.impulse_t += segment.slope * step;
        if (!ends) {
            ++k;
        } else if (now.compressing) {
            now.compressing = false;
            now.v_n = 0;
            now.compression_impulse = now.impulse_n;
        } else {
            break;
        }
    }
    r.impulse_n = now.impulse_n;
    r.v_n = v_n + c.nn * r.impulse_n + c.nt * r.impulse_t;
    r.v_t = v_t + c.nt * r.impulse_n + c.tt * r.impulse_t;
    return r;
}

}  // namespace beamcam::sim
