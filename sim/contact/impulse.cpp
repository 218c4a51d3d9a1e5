#include "sim/contact/impulse.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "sim/base/assert.hpp"
#include "sim/base/ode.hpp"

namespace beamcam::sim {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

// One straight segment of the path in the plane of impulses: dP_t = slope dP_n, over `length` of P_n.
struct PathSegment {
    double slope, length;
};

// Sliding until the slip vanishes; then sticking, or sliding in the other direction if friction cannot hold (S43).
std::array<PathSegment, 2> impulse_path(const Compliance& c, double v_t, double mu) {
    const double stick = -c.nt / c.tt;  // the slope that keeps v_t = 0
    const double direction = c.nt > 0 ? 1 : -1;
    const double after = std::fabs(stick) <= mu ? stick : -mu * direction;
    if (v_t == 0) return {{{after, kForever}, {after, kForever}}};
    const double sign = v_t > 0 ? 1 : -1, slope = -mu * sign;
    const double deceleration = -(c.nt + c.tt * slope) * sign;  // −d|v_t|/dP_n
    const double stops = deceleration > 0 ? std::fabs(v_t) / deceleration : kForever;
    return {{{slope, stops}, {after, kForever}}};
}

// The state of an impact.
struct State {
    bool compressing = true;
    double impulse_n, v_n;                              // now
    double compression_impulse = 0;                     // of the whole compression
    double compression_work = 0, restitution_work = 0;  // ∫v_n dP_n, < 0 and > 0
};

// The impulse P_n to the end of compression or, after that, of restitution while dv_n/dP_n = rate. kForever: no end.
double remaining(const State& now, double rate, double v_n_before, double restitution, ImpactLaw law) {
    if (now.compressing) return rate > 0 ? -now.v_n / rate : kForever;
    if (law == ImpactLaw::newton) return rate > 0 ? (-restitution * v_n_before - now.v_n) / rate : kForever;
    if (law == ImpactLaw::poisson) return (1 + restitution) * now.compression_impulse - now.impulse_n;
    // Stronge: v_n s + ½ rate s² = the missing work of restitution.
    const double missing = -restitution * restitution * now.compression_work - now.restitution_work;
    const double root = now.v_n * now.v_n + 2 * rate * missing;
    if (!(root >= 0)) return kForever;
    return missing <= 0 ? 0 : 2 * missing / (now.v_n + std::sqrt(root));
}

}  // namespace

ImpactResult resolve_impact(const Compliance& c, double v_n, double v_t, double friction, double restitution,
                            ImpactLaw law) {
    BEAMCAM_ASSERT(c.nn > 0 && c.tt >= 0 && friction >= 0);
    BEAMCAM_ASSERT(restitution >= 0 && restitution <= 1);
    ImpactResult r{0, 0, v_n, v_t};
    if (!(v_n < 0)) return r;
    const std::array<PathSegment, 2> path = impulse_path(c, v_t, friction);

    // Follow the path; v_n is linear in P_n on each segment. Compression ends where v_n passes zero.
    State now{.impulse_n = 0, .v_n = v_n};
    for (std::size_t k = 0; k < path.size();) {
        const PathSegment& segment = path[k];
        const double rate = c.nn + c.nt * segment.slope;  // dv_n/dP_n; negative while the contact jams
        double step = k == 0 ? segment.length - now.impulse_n : kForever;
        const double end = remaining(now, rate, v_n, restitution, law);
        const bool ends = end <= step;
        if (ends) step = end > 0 ? end : 0;
        // Never for a positive definite compliance.
        if (!std::isfinite(step)) throw ContactLocked();
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
