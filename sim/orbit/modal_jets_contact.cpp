// ModalJets: geometry of the contact, forces and impulses.
#include <cmath>

#include "sim/contact/impulse.hpp"
#include "sim/orbit/modal_jets.hpp"

namespace beamcam::sim {
namespace {

Jet power(const Jet& a, double n) {
    const double p = std::pow(a.v, n - 1);
    return chain(a, p * a.v, n * p);
}

// B − C (S23).
Jet2 cam_arm(const Cam& cam, const Jet& t) {
    const Jet psi = cam.phase - cam.speed * t;
    return {cam.eccentricity * cos(psi), cam.eccentricity * sin(psi)};
}

// F = K δⁿ (1 + D δ̇/δ̇₋), never negative (S30).
Jet normal_force(const NormalLaw& law, const Jet& depth, const Jet& rate, const Jet& approach) {
    if (!(depth.v > 0)) return 0;
    const Jet bracket = 1 + law.damping * (rate / approach);
    if (!(bracket.v > 0)) return 0;
    return law.stiffness * (power(depth, law.exponent) * bracket);
}

}  // namespace

// The centre line at x, which may depend on the tangents: ModalModel::point, jacobian and convective in jets.
void ModalJets::line(const Jet& x) {
    const bool shortened = model_.foreshortening() && modes_ > 0;
    const double a = problem_.hub.radius;
    model_.shapes().evaluate(x.v, y_.data(), y1_.data(), y2_.data(), y3_.data());
    if (shortened) model_.shortening_matrix(x.v, shortening_matrix_.data());
    Jet v, v1, v2, dv, dv1, u, du, u1, u2, du1, bend;
    for (int i = 0; i < modes_; ++i) {
        shape_[i] = {y_[i], x.d * y1_[i]};
        slope_[i] = {y1_[i], x.d * y2_[i]};
        curve_[i] = {y2_[i], x.d * y3_[i]};
        v += shape_[i] * q_[i];
        v1 += slope_[i] * q_[i];
        v2 += curve_[i] * q_[i];
        dv += shape_[i] * dq_[i];
        dv1 += slope_[i] * dq_[i];
    }
    if (shortened) {
        for (int i = 0; i < modes_; ++i) {
            Jet hq{0, x.d * (y1_[i] * v1.v)}, hdq{0, x.d * (y1_[i] * dv1.v)};  // H q, H q̇; ∂H/∂x = φ′φ′ᵀ
            for (int j = 0; j < modes_; ++j) {
                hq += shortening_matrix_(i, j) * q_[j];
                hdq += shortening_matrix_(i, j) * dq_[j];
            }
            shortening_[i] = hq;
            u -= 0.5 * (q_[i] * hq);
            du -= dq_[i] * hq;
            bend -= dq_[i] * hdq;
        }
        u -= 0.5 * a * (alpha_ * alpha_);
        du -= a * (alpha_ * alpha_dot_);
        bend -= a * (alpha_dot_ * alpha_dot_);
        u1 = -0.5 * (v1 * v1);
        u2 = -(v1 * v2);
        du1 = -(v1 * dv1);
    }
    const Jet2 along{cos_, sin_}, across{-sin_, cos_};
    const Jet rx = u + x + a;
    c_.along = along;
    c_.r = rx * along + v * across;
    c_.r1 = (1 + u1) * along + v1 * across;
    c_.r2 = u2 * along + v2 * across;
    c_.v = (du - v * Theta_dot_) * along + (dv + rx * Theta_dot_) * across;
    c_.v1 = (du1 - v1 * Theta_dot_) * along + (dv1 + (1 + u1) * Theta_dot_) * across;
    c_.bend = bend;
    const Jet speed2 = (1 + u1) * (1 + u1) + v1 * v1;
    c_.jn[0] = -c_.r.y;  // here ∂X/∂ξ and ∂Y/∂ξ; `contact` projects them onto n and t
    c_.jt[0] = c_.r.x;
    for (int i = 0; i < modes_; ++i) {
        Jet ui;
        if (shortened) ui = -shortening_[i] - (a * model_.hub_row()[1 + i]) * alpha_;
        c_.jn[1 + i] = ui * along.x + shape_[i] * across.x;
        c_.jt[1 + i] = ui * along.y + shape_[i] * across.y;
        // curve_ now stores ∂χ/∂q; the curvature is no longer needed.
        curve_[i] = ((1 + u1) * slope_[i] + (shortened ? v1 * v1 * slope_[i] : Jet())) / speed2;
    }
}

// Foot, gap, slip and the rows of the contact. The derivative of the foot follows from r′·(r − B) = 0.          (S24)
void ModalJets::contact(const JetState& s, const ContactState& near) {
    const Cam& cam = *problem_.cam;
    const Jet2 arm = cam_arm(cam, s.t), disc = Jet2{cam.centre.x, cam.centre.y} + arm;
    const Jet2 disc_rate{cam.speed * arm.y, -cam.speed * arm.x};
    line(near.x);
    if (!near.at_end) {
        const Jet foot = dot(c_.r1, c_.r - disc);
        line({near.x, -foot.d / (dot(c_.r2, c_.r - disc).v + dot(c_.r1, c_.r1).v)});
    }
    const Jet2 d = c_.r - disc, w = c_.v - disc_rate;
    c_.distance = sqrt(dot(d, d));
    c_.normal = (1.0 / c_.distance) * d;
    const Jet2 tangent{c_.normal.y, -c_.normal.x};
    c_.gap_rate = dot(c_.normal, w);
    c_.slip = dot(tangent, w) + offset_ * (cross(c_.r1, c_.v1) / dot(c_.r1, c_.r1)) - cam.speed * cam.radius;
    for (int i = 0; i < n_; ++i) {
        const Jet2 column{c_.jn[i], c_.jt[i]};
        c_.jn[i] = dot(c_.normal, column);
        c_.jt[i] = dot(tangent, column) + offset_ * (i == 0 ? Jet(1) : curve_[i - 1]);
    }
}

Jet ModalJets::friction_ratio() const { return -friction_.kinetic * tanh(c_.slip / friction_.slip_speed); }

// The normal force of sustained contact (S45), after `assemble`.
Jet ModalJets::constraint_force(const JetState& s, bool at_end) {
    const Cam& cam = *problem_.cam;
    const Jet2 arm = cam_arm(cam, s.t);
    const Jet2 d = c_.distance * c_.normal, w = c_.v - Jet2{cam.speed * arm.y, -cam.speed * arm.x};
    const Jet rate = at_end ? Jet() : -(dot(c_.v1, d) + dot(c_.r1, w)) / (dot(c_.r2, d) + dot(c_.r1, c_.r1));
    const Jet2 d_rate = w + rate * c_.r1;
    const Jet2 n_rate = (1.0 / c_.distance) * (d_rate - dot(c_.normal, d_rate) * c_.normal);
    const Jet2 relative{c_.v.x + Theta_dot_ * c_.r.y, c_.v.y - Theta_dot_ * c_.r.x};  // relative to the rotating frame
    const Jet2 convective =
        -(Theta_dot_ * Theta_dot_) * c_.r + 2 * Theta_dot_ * Jet2{-relative.y, relative.x} + c_.bend * c_.along;
    const Jet2 disc_acceleration = Jet(-cam.speed * cam.speed) * arm;
    Jet gap_acceleration = dot(n_rate, w) + dot(c_.normal, convective + rate * c_.v1 - disc_acceleration);  // (S44)
    const Jet ratio = friction_.none() ? Jet() : friction_ratio();
    JetVector free = force_, response(n_);
    for (int i = 0; i < n_; ++i) response[i] = c_.jn[i] + ratio * c_.jt[i];
    solve(s, free, true);
    solve(s, response, false);
    Jet per_newton;
    for (int i = 0; i < n_; ++i) {
        gap_acceleration += c_.jn[i] * free[i];
        per_newton += c_.jn[i] * response[i];
    }
    const Jet gap = c_.distance - (cam.radius + offset_);
    const Jet decay = baumgarte_rate_ * (2 * c_.gap_rate + baumgarte_rate_ * (gap - gap.v));
    return -(decay + gap_acceleration) / per_newton;
}

Jet ModalJets::sliding_bristle(FrictionState state, const Forces& f) const {
    return (FrictionLaw::sign(state) * friction_.kinetic / friction_.stiffness) * f.normal;
}

// After `assemble` and `contact`; friction as FrictionLaw::force.
ModalJets::Forces ModalJets::current_forces(const JetState& s, const Phase& phase, bool at_end) {
    Forces f;
    f.slip = c_.slip;
    const Jet depth = problem_.cam->radius + offset_ - phase.gap_offset - c_.distance;
    f.normal = phase.held ? constraint_force(s, at_end) : normal_force(law_, depth, -c_.gap_rate, s.approach);
    if (friction_.none()) return f;
    if (!friction_.bristle)
        f.friction = friction_ratio() * f.normal;
    else if (phase.friction == FrictionState::stick)
        f.friction = -(friction_.stiffness * s.bristle + friction_.damping * c_.slip);
    else
        f.friction = (-FrictionLaw::sign(phase.friction) * friction_.kinetic) * f.normal;
    return f;
}

ModalJets::Forces ModalJets::forces(const JetState& s, const Phase& phase, const ContactState& near) {
    set(s);
    assemble(s);
    contact(s, near);
    return current_forces(s, phase, near.at_end);
}

ModalJets::Gap ModalJets::gap(const JetState& s, const ContactState& near) {
    set(s);
    contact(s, near);
    return {c_.distance - (problem_.cam->radius + offset_), c_.gap_rate};
}

double ModalJets::foot(const ContactState& near) const {
    if (!near.at_end) return near.x;
    return near.x - c_.distance.v * dot(c_.r1, c_.normal).v / dot(c_.r1, c_.r1).v;
}

// ξ̇ ← ξ̇ + M⁻¹(J_nᵀP_n + J_tᵀP_t)                                                                               (S43)
void ModalJets::apply_impact(JetState& s, const ContactState& near, double restitution) {
    set(s);
    assemble(s);
    contact(s, near);
    JetVector by_n = c_.jn, by_t = c_.jt;
    solve(s, by_n, false);
    solve(s, by_t, false);
    ComplianceOf<Jet> compliance{0, 0, 0};
    for (int i = 0; i < n_; ++i) {
        compliance.nn += c_.jn[i] * by_n[i];
        compliance.nt += 0.5 * (c_.jt[i] * by_n[i] + c_.jn[i] * by_t[i]);
        compliance.tt += c_.jt[i] * by_t[i];
    }
    const ImpactResultOf<Jet> impact =
        resolve_impact<Jet>(compliance, c_.gap_rate, c_.slip, friction_.kinetic, restitution, problem_.contact.law);
    for (int i = 0; i < n_; ++i) s.rate[i] += impact.impulse_n * by_n[i] + impact.impulse_t * by_t[i];
}

}  // namespace beamcam::sim
