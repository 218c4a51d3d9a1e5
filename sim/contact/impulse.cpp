#include "sim/contact/impulse.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "sim/base/assert.hpp"
#include "sim/base/ode.hpp"

namespace beamcam::sim {
namespace {

// One straight piece of the impact: dP_t = slope dP_n, until `length` of P_n.
struct ImpulsePiece {
    double slope, length;
};

// Sliding until the slip stops, then sticking, or sliding on the other way when friction cannot hold (S43).
std::array<ImpulsePiece, 2> course(const Compliance& c, double v_t, double mu) {
    constexpr double kForever = std::numeric_limits<double>::infinity();
    const double hold = -c.nt / c.tt;  // slope that keeps v_t = 0
    const double way = c.nt > 0 ? 1 : -1;
    const double after = std::fabs(hold) <= mu ? hold : -mu * way;
    if (v_t == 0) return {{{after, kForever}, {after, kForever}}};
    const double sign = v_t > 0 ? 1 : -1, slope = -mu * sign;
    const double deceleration = -(c.nt + c.tt * slope) * sign;  // of |v_t| by P_n
    const double stops = deceleration > 0 ? std::fabs(v_t) / deceleration : kForever;
    return {{{slope, stops}, {after, kForever}}};
}

}  // namespace

ImpactResult resolve_impact(const Compliance& c, double v_n, double v_t, double friction, double restitution,
                            ImpactLaw law) {
    BEAMCAM_ASSERT(c.nn > 0 && c.tt >= 0 && friction >= 0);
    BEAMCAM_ASSERT(restitution >= 0 && restitution <= 1);
    ImpactResult r{0, 0, v_n, v_t};
    if (!(v_n < 0)) return r;
    const std::array<ImpulsePiece, 2> pieces = course(c, v_t, friction);

    // Walk along the pieces; v_n is linear in P_n on each. Compression ends where it passes zero.
    double compression_work = 0, restitution_work = 0;  // ∫v_n dP_n, < 0 and > 0
    double target_impulse = std::numeric_limits<double>::infinity();
    bool compressing = true;
    for (std::size_t k = 0; k < pieces.size();) {
        const ImpulsePiece& piece = pieces[k];
        const double rate = c.nn + c.nt * piece.slope;  // dv_n/dP_n; may be < 0 while it jams
        double step = k == 0 ? piece.length - r.impulse_n : std::numeric_limits<double>::infinity();
        if (k == 0 && piece.length == std::numeric_limits<double>::infinity()) step = piece.length;
        enum { next_piece, compressed, done } why = next_piece;
        const auto end_at = [&](double length, auto reason) {
            if (length <= step) {
                step = std::fmax(0.0, length);
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
            const double lacking = -restitution * restitution * compression_work - restitution_work;
            const double root = r.v_n * r.v_n + 2 * rate * lacking;
            if (root >= 0) end_at(lacking <= 0 ? 0 : 2 * lacking / (r.v_n + std::sqrt(root)), done);
        }
        // Never for a positive definite compliance.
        if (!std::isfinite(step)) throw StepFailure("the equations of the impact have no solution");
        const double work = r.v_n * step + 0.5 * rate * step * step;
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
