#include "sim/orbit/modal_jets.hpp"

#include <fmt/format.h>

#include <cmath>

#include "sim/contact/impulse_of.hpp"

namespace beamcam::sim {
namespace {

std::size_t entry(int i) { return static_cast<std::size_t>(i); }

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

std::optional<std::string> tangent_refusal(const Problem& problem) {
    switch (problem.beam.model) {
        case ModelKind::rigid:
        case ModelKind::zeroth_order:
        case ModelKind::first_order:
            break;
        case ModelKind::paper:
        case ModelKind::second_order:
        case ModelKind::exact:
            return fmt::format("the tangent flow of the model {} is not known; use beam.model first-order or rigid",
                               name(problem.beam.model));
    }
    return std::nullopt;
}

ModalJets::ModalJets(System& system)
    : problem_(system.problem()),
      model_(dynamic_cast<const ModalModel&>(system.model())),
      m_(model_.matrices()),
      drive_(system.drive()),
      law_(system.normal_law()),
      friction_(system.friction()),
      n_(system.coordinates()),
      modes_(n_ - 1),
      offset_(system.offset()),
      baumgarte_rate_(system.baumgarte_rate()),
      damping_(model_.damping_matrix()),
      q_(entry(modes_)),
      dq_(entry(modes_)),
      bq_(entry(modes_)),
      force_(entry(n_)),
      y_(entry(modes_)),
      y1_(entry(modes_)),
      y2_(entry(modes_)),
      y3_(entry(modes_)),
      h_(entry(modes_ * modes_)),
      shape_(entry(modes_)),
      slope_(entry(modes_)),
      curve_(entry(modes_)),
      shortening_(entry(modes_)) {
    c_.jn.resize(entry(n_));
    c_.jt.resize(entry(n_));
}

void ModalJets::set(const JetState& s) {
    angle_ = s.xi[0];
    spin_ = s.rate[0];
    if (drive_.prescribed()) {
        const HubMotion hub = drive_.motion(s.t.v);
        angle_ = chain(s.t, hub.angle, hub.rate);
        spin_ = chain(s.t, hub.rate, hub.acceleration);
    }
    sin_ = sin(angle_);
    cos_ = cos(angle_);
    turn_ = turn_rate_ = 0;
    for (int i = 0; i < modes_; ++i) {
        q_[entry(i)] = s.xi[entry(1 + i)];
        dq_[entry(i)] = s.rate[entry(1 + i)];
        turn_ += model_.hub_row()[1 + i] * q_[entry(i)];
        turn_rate_ += model_.hub_row()[1 + i] * dq_[entry(i)];
    }
}

// The centre line at x, which may move with the tangents: ModalModel::point, jacobian and convective in jets.
void ModalJets::line(const Jet& x) {
    const bool shortened = model_.foreshortening() && modes_ > 0;
    const double a = problem_.hub.radius;
    model_.shapes().evaluate(x.v, y_.data(), y1_.data(), y2_.data(), y3_.data());
    if (shortened) model_.shortening_matrix(x.v, h_.data());
    Jet v, v1, v2, dv, dv1, u, du, u1, u2, du1, bend;
    for (int i = 0; i < modes_; ++i) {
        shape_[entry(i)] = {y_[entry(i)], x.d * y1_[entry(i)]};
        slope_[entry(i)] = {y1_[entry(i)], x.d * y2_[entry(i)]};
        curve_[entry(i)] = {y2_[entry(i)], x.d * y3_[entry(i)]};
        v += shape_[entry(i)] * q_[entry(i)];
        v1 += slope_[entry(i)] * q_[entry(i)];
        v2 += curve_[entry(i)] * q_[entry(i)];
        dv += shape_[entry(i)] * dq_[entry(i)];
        dv1 += slope_[entry(i)] * dq_[entry(i)];
    }
    if (shortened) {
        for (int i = 0; i < modes_; ++i) {
            Jet hq{0, x.d * (y1_[entry(i)] * v1.v)}, hdq{0, x.d * (y1_[entry(i)] * dv1.v)};  // H q, H q̇; ∂H/∂x = φ′φ′ᵀ
            for (int j = 0; j < modes_; ++j) {
                hq += h_[entry(j * modes_ + i)] * q_[entry(j)];
                hdq += h_[entry(j * modes_ + i)] * dq_[entry(j)];
            }
            shortening_[entry(i)] = hq;
            u -= 0.5 * (q_[entry(i)] * hq);
            du -= dq_[entry(i)] * hq;
            bend -= dq_[entry(i)] * hdq;
        }
        u -= 0.5 * a * (turn_ * turn_);
        du -= a * (turn_ * turn_rate_);
        bend -= a * (turn_rate_ * turn_rate_);
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
    c_.v = (du - v * spin_) * along + (dv + rx * spin_) * across;
    c_.v1 = (du1 - v1 * spin_) * along + (dv1 + (1 + u1) * spin_) * across;
    c_.bend = bend;
    const Jet speed2 = (1 + u1) * (1 + u1) + v1 * v1;
    c_.jn[0] = -c_.r.y;  // for now ∂x/∂Θ, ∂y/∂Θ; `contact` turns them to n and t
    c_.jt[0] = c_.r.x;
    for (int i = 0; i < modes_; ++i) {
        Jet ui;
        if (shortened) ui = -shortening_[entry(i)] - (a * model_.hub_row()[1 + i]) * turn_;
        c_.jn[entry(1 + i)] = ui * along.x + shape_[entry(i)] * across.x;
        c_.jt[entry(1 + i)] = ui * along.y + shape_[entry(i)] * across.y;
        // ∂χ/∂q takes the place of a curvature that nobody needs any more.
        curve_[entry(i)] = ((1 + u1) * slope_[entry(i)] + (shortened ? v1 * v1 * slope_[entry(i)] : Jet())) / speed2;
    }
}

// Foot, gap, slip and the rows of the contact. The foot moves with the tangents as r′·(r − B) = 0 demands.      (S24)
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
        const Jet2 column{c_.jn[entry(i)], c_.jt[entry(i)]};
        c_.jn[entry(i)] = dot(c_.normal, column);
        c_.jt[entry(i)] = dot(tangent, column) + offset_ * (i == 0 ? Jet(1) : curve_[entry(i - 1)]);
    }
}

// Forces and inertia of hub and beam (S14).
void ModalJets::assemble(const JetState& s) {
    const double g = problem_.gravity;
    const bool shortened = model_.foreshortening();
    const Eigen::MatrixXd& B = model_.inertia_matrix();
    Jet coriolis, qbq, wq, qgq;
    for (int i = 0; i < modes_; ++i) {
        Jet bq, gq, damping;
        for (int j = 0; j < modes_; ++j) {
            bq += B(i, j) * q_[entry(j)];
            if (shortened) gq += m_.G(i, j) * q_[entry(j)];
        }
        if (!damping_.empty())
            for (int j = 0; j < modes_; ++j) damping += damping_[entry(j * modes_ + i)] * dq_[entry(j)];
        coriolis += bq * dq_[entry(i)];
        qbq += bq * q_[entry(i)];
        wq += m_.W[i] * q_[entry(i)];
        qgq += gq * q_[entry(i)];
        force_[entry(1 + i)] =
            spin_ * spin_ * bq + g * (sin_ * gq) - m_.K[i] * q_[entry(i)] - (g * m_.W[i]) * cos_ - damping;
    }
    inertia_ = m_.J + qbq;
    force_[0] = -2 * (spin_ * coriolis) - g * (m_.S * cos_ - wq * sin_ - 0.5 * (cos_ * qgq));
    if (!drive_.has_torque()) return;
    const double torque = drive_.torque(s.t.v);
    for (int i = 0; i < n_; ++i) force_[entry(i)] += torque * model_.hub_row()[i];
}

// f ← M⁻¹f; a prescribed hub turns as it must if `driven`, else it is held.
void ModalJets::solve(const JetState& s, std::vector<Jet>& f, bool driven) const {
    const double mass = model_.mass();
    if (drive_.prescribed()) {
        f[0] = driven ? drive_.motion(s.t.v).acceleration : 0;
    } else if (model_.coupled()) {
        Jet hub = f[0];
        for (int i = 0; i < modes_; ++i) hub -= (m_.U[i] / mass) * f[entry(1 + i)];
        f[0] = hub / (inertia_ - m_.U.squaredNorm() / mass);
    } else {
        f[0] = f[0] / inertia_;
    }
    for (int i = 0; i < modes_; ++i) {
        if (model_.coupled()) f[entry(1 + i)] -= m_.U[i] * f[0];
        f[entry(1 + i)] = f[entry(1 + i)] / mass;
    }
}

Jet ModalJets::friction_ratio() const { return -friction_.kinetic * tanh(c_.slip / friction_.slip_speed); }

// The force of sustained contact (S45); force_ is the assembled one.
Jet ModalJets::hold(const JetState& s, bool at_end) {
    const Cam& cam = *problem_.cam;
    const Jet2 arm = cam_arm(cam, s.t);
    const Jet2 d = c_.distance * c_.normal, w = c_.v - Jet2{cam.speed * arm.y, -cam.speed * arm.x};
    const Jet rate = at_end ? Jet() : -(dot(c_.v1, d) + dot(c_.r1, w)) / (dot(c_.r2, d) + dot(c_.r1, c_.r1));
    const Jet2 d_rate = w + rate * c_.r1;
    const Jet2 n_rate = (1.0 / c_.distance) * (d_rate - dot(c_.normal, d_rate) * c_.normal);
    const Jet2 relative{c_.v.x + spin_ * c_.r.y, c_.v.y - spin_ * c_.r.x};  // to the turning frame
    const Jet2 convective = -(spin_ * spin_) * c_.r + 2 * spin_ * Jet2{-relative.y, relative.x} + c_.bend * c_.along;
    const Jet2 disc_acceleration = Jet(-cam.speed * cam.speed) * arm;
    Jet gap_acceleration = dot(n_rate, w) + dot(c_.normal, convective + rate * c_.v1 - disc_acceleration);  // (S44)
    const Jet ratio = friction_.none() ? Jet() : friction_ratio();
    std::vector<Jet> free = force_, answer(entry(n_));
    for (int i = 0; i < n_; ++i) answer[entry(i)] = c_.jn[entry(i)] + ratio * c_.jt[entry(i)];
    solve(s, free, true);
    solve(s, answer, false);
    Jet per_newton;
    for (int i = 0; i < n_; ++i) {
        gap_acceleration += c_.jn[entry(i)] * free[entry(i)];
        per_newton += c_.jn[entry(i)] * answer[entry(i)];
    }
    const Jet gap = c_.distance - (cam.radius + offset_);
    const Jet decay = baumgarte_rate_ * (2 * c_.gap_rate + baumgarte_rate_ * (gap - gap.v));
    return -(decay + gap_acceleration) / per_newton;
}

Jet ModalJets::sliding_bristle(Grip grip, const Forces& f) const {
    return (FrictionLaw::sign(grip) * friction_.kinetic / friction_.stiffness) * f.normal;
}

// After `assemble` and `contact`; friction as FrictionLaw::force.
ModalJets::Forces ModalJets::placed_forces(const JetState& s, const Phase& phase, bool at_end) {
    Forces f;
    f.slip = c_.slip;
    const Jet depth = problem_.cam->radius + offset_ - phase.gap_offset - c_.distance;
    f.normal = phase.held ? hold(s, at_end) : normal_force(law_, depth, -c_.gap_rate, s.approach);
    if (friction_.none()) return f;
    if (!friction_.bristle)
        f.friction = friction_ratio() * f.normal;
    else if (phase.grip == Grip::stick)
        f.friction = -(friction_.stiffness * s.bristle + friction_.damping * c_.slip);
    else
        f.friction = (-FrictionLaw::sign(phase.grip) * friction_.kinetic) * f.normal;
    return f;
}

ModalJets::Forces ModalJets::forces(const JetState& s, const Phase& phase, const ContactState& near) {
    set(s);
    assemble(s);
    contact(s, near);
    return placed_forces(s, phase, near.at_end);
}

void ModalJets::flow(const JetState& s, const Phase& phase, const ContactState& near, std::vector<Jet>& acceleration,
                     Jet& bristle_rate) {
    set(s);
    assemble(s);
    bristle_rate = 0;
    if (phase.touching) {
        contact(s, near);
        const Forces f = placed_forces(s, phase, near.at_end);
        for (int i = 0; i < n_; ++i)
            force_[entry(i)] += f.normal * c_.jn[entry(i)] + f.friction * c_.jt[entry(i)];  // (S28)
        if (friction_.bristle && phase.grip == Grip::stick)
            bristle_rate = f.slip;
        else if (friction_.lags)
            bristle_rate = (friction_.stiffness / friction_.damping) * (sliding_bristle(phase.grip, f) - s.bristle);
    }
    solve(s, force_, true);
    acceleration = force_;
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
void ModalJets::strike(JetState& s, const ContactState& near, double restitution) {
    set(s);
    assemble(s);
    contact(s, near);
    std::vector<Jet> by_n = c_.jn, by_t = c_.jt;
    solve(s, by_n, false);
    solve(s, by_t, false);
    ComplianceOf<Jet> compliance{0, 0, 0};
    for (int i = 0; i < n_; ++i) {
        compliance.nn += c_.jn[entry(i)] * by_n[entry(i)];
        compliance.nt += 0.5 * (c_.jt[entry(i)] * by_n[entry(i)] + c_.jn[entry(i)] * by_t[entry(i)]);
        compliance.tt += c_.jt[entry(i)] * by_t[entry(i)];
    }
    const ImpactResultOf<Jet> impact =
        resolve_impact<Jet>(compliance, c_.gap_rate, c_.slip, friction_.kinetic, restitution, problem_.contact.law);
    for (int i = 0; i < n_; ++i)
        s.rate[entry(i)] += impact.impulse_n * by_n[entry(i)] + impact.impulse_t * by_t[entry(i)];
}

double ModalJets::inertia_share(const double* q) const {
    if (drive_.prescribed() || modes_ == 0) return 1;
    const Eigen::Map<const Eigen::VectorXd> coordinates(q, modes_);
    const double condensed = model_.coupled() ? m_.U.squaredNorm() / model_.mass() : 0;
    return 1 + coordinates.dot(model_.inertia_matrix() * coordinates) / (m_.J - condensed);
}

}  // namespace beamcam::sim
