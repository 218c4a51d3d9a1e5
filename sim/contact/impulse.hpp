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

}  // namespace impulse

// v_n < 0 approaches. `friction` is μ >= 0, `restitution` in [0, 1]. Throws StepFailure where no impulse ends the
// impact (jamming of a singular compliance).
template <class T>
ImpactResultOf<T> resolve_impact(const ComplianceOf<T>& c, const std::type_identity_t<T>& v_n,
                                 const std::type_identity_t<T>& v_t, double friction, double restitution,
                                 ImpactLaw law) {
    using std::isfinite, std::sqrt;
    BEAMCAM_ASSERT(c.nn > 0 && c.tt >= 0 && friction >= 0);
    BEAMCAM_ASSERT(restitution >= 0 && restitution <= 1);
    ImpactResultOf<T> r{0, 0, v_n, v_t};
    if (!(v_n < 0)) return r;
    const std::array<impulse::PathSegment<T>, 2> path = impulse::impulse_path(c, v_t, friction);

    // Follow the path; v_n is linear in P_n on each segment. Compression ends where v_n passes zero.
    T compression_work = 0, restitution_work = 0;  // ∫v_n dP_n, < 0 and > 0
    T target_impulse = impulse::kForever;
    bool compressing = true;
    for (std::size_t k = 0; k < path.size();) {
        const impulse::PathSegment<T>& segment = path[k];
        const T rate = c.nn + c.nt * segment.slope;  // dv_n/dP_n; negative while the contact jams
        T step = k == 0 ? segment.length - r.impulse_n : T(impulse::kForever);
        if (k == 0 && !isfinite(segment.length)) step = segment.length;
        enum { next_segment, compressed, done } why = next_segment;
        const auto end_at = [&](const T& length, auto reason) {
            if (length <= step) {
                step = length > 0 ? length : T(0);
                why = reason;
            }
        };
        if (compressing) {
            if (rate > 0) end_at(-r.v_n / rate, compressed);
        } else if (law == ImpactLaw::newton) {
            if (rate > 0) end_at((-restitution * v_n - r.v_n) / rate, done);
        } else if (law == ImpactLaw::poisson) {
            end_at(target_impulse - r.impulse_n, done);
        } else {
            // Stronge: v_n s + ½ rate s² = the missing work of restitution.
            const T missing = -restitution * restitution * compression_work - restitution_work;
            const T root = r.v_n * r.v_n + 2 * rate * missing;
            if (root >= 0) end_at(missing <= 0 ? T(0) : 2 * missing / (r.v_n + sqrt(root)), done);
        }
        // Never for a positive definite compliance.
        if (!isfinite(step)) throw StepFailure("the equations of the impact have no solution");
        const T work = r.v_n * step + 0.5 * rate * step * step;
        (compressing ? compression_work : restitution_work) += work;
        r.impulse_n += step;
        r.impulse_t += segment.slope * step;
        r.v_n += rate * step;
        if (why == done) break;
        if (why == compressed) {
            compressing = false;
            r.v_n = 0;
            target_impulse = (1 + restitution) * r.impulse_n;
        } else {
            ++k;
        }
    }
    r.v_n = v_n + c.nn * r.impulse_n + c.nt * r.impulse_t;
    r.v_t = v_t + c.nt * r.impulse_n + c.tt * r.impulse_t;
    return r;
}

}  // namespace beamcam::sim
