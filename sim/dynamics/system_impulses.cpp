// Impulses of the contact on the system: its response to them, and the jumps of its state.
#include <algorithm>
#include <limits>

#include "sim/base/assert.hpp"
#include "sim/dynamics/system.hpp"

namespace beamcam::sim {

Compliance System::compliance(double t, const double* y, const ContactState& c) {
    double f[kMaxSize], jn[kMaxSize], jt[kMaxSize], by_n[kMaxSize], by_t[kMaxSize];
    set_state(t, y);
    require_inertia(f);
    contact_rows(c, jn, jt);
    std::copy_n(jn, n_, by_n);
    std::copy_n(jt, n_, by_t);
    respond(by_n);
    respond(by_t);
    Compliance out{0, 0, 0};
    for (int i = 0; i < n_; ++i) {
        out.nn += jn[i] * by_n[i];
        out.nt += 0.5 * (jt[i] * by_n[i] + jn[i] * by_t[i]);
        out.tt += jt[i] * by_t[i];
    }
    return out;
}

ContactState System::hold(double t, double off, double* y) {
    BEAMCAM_ASSERT(phase_.held);
    double jn[kMaxSize], jt[kMaxSize], jump[kMaxSize], per_impulse = 0;
    const ContactState c = contact(t, y);
    contact_rows(c, jn, jt);
    std::copy_n(jn, n_, jump);
    respond(jump);
    for (int i = 0; i < n_; ++i) per_impulse += jn[i] * jump[i];
    for (int i = 0; i < n_; ++i) y[n_ + i] -= (off_constraint(c.gap, c.gap_rate) - off) / per_impulse * jump[i];
    return c;
}

double System::touch_time(double t, const double* y, const ContactState& c, double approach) {
    const double per_newton = compliance(t, y, c).nn;
    if (!(approach > 0) || !(per_newton > 0)) return std::numeric_limits<double>::infinity();
    return impact_depth(law_.exponent, per_newton * law_.at(c.disc.radius).stiffness, 1, approach) / approach;
}

void System::apply_impact(double t, double* y, const ContactState& c, const ImpactResult& impact) {
    BEAMCAM_ASSERT(impact.impulse_n >= 0);
    double f[kMaxSize], jn[kMaxSize], jt[kMaxSize], jump[kMaxSize];
    set_state(t, y);
    require_inertia(f);
    contact_rows(c, jn, jt);
    for (int i = 0; i < n_; ++i) jump[i] = impact.impulse_n * jn[i] + impact.impulse_t * jt[i];
    double* ledger = y + ledger_at;
    if (drive_.prescribed())
        ledger[kWorkDrive] += model_->solve_held(jump, 0) * drive_.motion(t).rate;
    else
        model_->solve(jump);
    for (int i = 0; i < n_; ++i) y[n_ + i] += jump[i];
    // Work of an impulse = impulse × mean of the speeds before and after (S46).
    ledger[kNormalWork] -= impact.impulse_n * 0.5 * (c.gap_rate + impact.v_n);
    ledger[kFrictionWork] -= impact.impulse_t * 0.5 * (c.slip + impact.v_t);
    ledger[kWorkCam] += cam_power(c, impact.impulse_n, impact.impulse_t);
    ledger[kImpulseN] += impact.impulse_n;
    ledger[kImpulseT] += impact.impulse_t;
}

}  // namespace beamcam::sim
