// The construction of impulse.hpp for numbers of any kind: doubles, or such as carry derivatives.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "sim/base/assert.hpp"
#include "sim/base/ode.hpp"
#include "sim/contact/impulse.hpp"

namespace beamcam::sim {
namespace impulse {

// One straight piece of the impact: dP_t = slope dP_n, until `length` of P_n.
template <class T>
struct ImpulsePiece {
    T slope, length;
};

// Sliding until the slip stops, then sticking, or sliding on the other way when friction cannot hold (S43).
template <class T>
std::array<ImpulsePiece<T>, 2> course(const ComplianceOf<T>& c, const T& v_t, double mu) {
    using std::fabs;
    constexpr double kForever = std::numeric_limits<double>::infinity();
    const T hold = -c.nt / c.tt;  // slope that keeps v_t = 0
    const double way = c.nt > 0 ? 1 : -1;
    const T after = fabs(hold) <= mu ? hold : T(-mu * way);
    if (v_t == 0) return {{{after, T(kForever)}, {after, T(kForever)}}};
    const double sign = v_t > 0 ? 1 : -1, slope = -mu * sign;
    const T deceleration = -(c.nt + c.tt * slope) * sign;  // of |v_t| by P_n
    const T stops = deceleration > 0 ? fabs(v_t) / deceleration : T(kForever);
    return {{{T(slope), stops}, {after, T(kForever)}}};
}

}  // namespace impulse

template <class T>
ImpactResultOf<T> resolve_impact(const ComplianceOf<T>& c, const T& v_n, const T& v_t, double friction,
                                 double restitution, ImpactLaw law) {
    using std::isfinite, std::sqrt;
    BEAMCAM_ASSERT(c.nn > 0 && c.tt >= 0 && friction >= 0);
    BEAMCAM_ASSERT(restitution >= 0 && restitution <= 1);
    ImpactResultOf<T> r{0, 0, v_n, v_t};
    if (!(v_n < 0)) return r;
    const std::array<impulse::ImpulsePiece<T>, 2> pieces = impulse::course(c, v_t, friction);

    // Walk along the pieces; v_n is linear in P_n on each. Compression ends where it passes zero.
    T compression_work = 0, restitution_work = 0;  // ∫v_n dP_n, < 0 and > 0
    T target_impulse = std::numeric_limits<double>::infinity();
    bool compressing = true;
    for (std::size_t k = 0; k < pieces.size();) {
        const impulse::ImpulsePiece<T>& piece = pieces[k];
        const T rate = c.nn + c.nt * piece.slope;  // dv_n/dP_n; may be < 0 while it jams
        T step = k == 0 ? piece.length - r.impulse_n : T(std::numeric_limits<double>::infinity());
        if (k == 0 && !isfinite(piece.length)) step = piece.length;
        enum { next_piece, compressed, done } why = next_piece;
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
            // v_n s + ½ rate s² = what the work still lacks (Stronge).
            const T lacking = -restitution * restitution * compression_work - restitution_work;
            const T root = r.v_n * r.v_n + 2 * rate * lacking;
            if (root >= 0) end_at(lacking <= 0 ? T(0) : 2 * lacking / (r.v_n + sqrt(root)), done);
        }
        // Never for a positive definite compliance.
        if (!isfinite(step)) throw StepFailure("the equations of the impact have no solution");
        const T work = r.v_n * step + 0.5 * rate * step * step;
        (compressing ? compression_work : restitution_work) += work;
        r.impulse_n += step;
        r.impulse_t += piece.slope * step;
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
