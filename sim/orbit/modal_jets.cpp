#include "sim/orbit/modal_jets.hpp"

#include "sim/contact/impulse.hpp"

namespace beamcam::sim {

// The outline of the cam about an angle, by the derivatives h″ = ρ − h and h‴ = ρ′ − h′.
template <class T>
static void outline(const CamShape& cam, const T& alpha, T& h, T& slope, T& radius) {
    const double a = value_of(alpha), bend = cam.radius_slope(a);
    const CamPoint at = cam.at(a);
    const double h2 = at.radius - at.h, h3 = bend - at.slope;
    const T turn = alpha - a;
    h = at.h + turn * (at.slope + turn * (0.5 * h2 + (h3 / 6) * turn));
    slope = at.slope + turn * (h2 + (0.5 * h3) * turn);
    radius = at.radius + bend * turn;
}

JetState::JetState(const System& system, double time, const double* y, const Phase& phase)
    : t(time),
      xi(y, y + system.coordinates()),
      rate(y + system.coordinates(), y + 2 * system.coordinates()),
      bristle(system.has_bristle() ? y[2 * system.coordinates()] : 0),
      approach(phase.approach) {}

ModalJets::ModalJets(System& system)
    : problem_(system.problem()),
      model_(dynamic_cast<const ModalModel&>(system.model())),
      cam_(system.cam()),
      drive_(system.drive()),
      law_(system.normal_law()),
      friction_(system.friction()),
      n_(system.coordinates()),
      modes_(n_ - 1),
      baumgarte_rate_(system.baumgarte_rate()),
      force_(static_cast<std::size_t>(n_)),
      jn_(force_),
      jt_(force_),
      hq_(force_) {
    if (system.has_cam()) expansion_.emplace(system);
}

// Forces and inertia of hub and beam (S14).
void ModalJets::assemble(const JetState& s) {
    const double g = problem_.gravity;
    const bool shortened = model_.foreshortening();
    const ModalMatrices& m = model_.matrices();
    const Jet sine = sin(s.xi[0]), cosine = cos(s.xi[0]), square = s.rate[0] * s.rate[0];
    const Jet *q = s.xi.data() + 1, *dq = s.rate.data() + 1;
    Jet* f = force_.data();
    Jet coriolis, qbq, wq, qgq;
    for (int i = 0; i < modes_; ++i) {
        Jet bq, gq, damping;
        for (int j = 0; j < modes_; ++j) {
            bq += model_.inertia_matrix()(i, j) * q[j];
            if (shortened) gq += m.G(i, j) * q[j];
            if (model_.damping()) damping += (*model_.damping())(i, j) * dq[j];
        }
        coriolis += bq * dq[i];
        qbq += bq * q[i];
        wq += m.W[i] * q[i];
        qgq += gq * q[i];
        f[1 + i] = square * bq + g * (sine * gq) - m.K[i] * q[i] - (g * m.W[i]) * cosine - damping;
    }
    inertia_ = m.J + qbq;
    f[0] = -2 * (s.rate[0] * coriolis) - g * (m.S * cosine - wq * sine - 0.5 * (cosine * qgq));
    const std::optional<HubSpring>& spring = problem_.hub.spring;
    if (!drive_.has_torque() && !spring) return;
    Jet torque = drive_.has_torque() ? drive_.torque(s.t.v) : 0;
    const double* hub = model_.hub_row();
    for (int i = 0; spring && i < n_; ++i)
        torque -= hub[i] * (spring->stiffness * s.xi[i] + spring->damping * s.rate[i]);
    if (spring) torque += spring->stiffness * spring->free_angle;
    for (int i = 0; i < n_; ++i) f[i] += hub[i] * torque;
}

// f ← M⁻¹f; a prescribed hub has its own acceleration if `driven`, else none.
void ModalJets::solve(const JetState& s, std::vector<Jet>& forces, bool driven) const {
    const double mass = model_.mass();
    const Eigen::VectorXd& U = model_.matrices().U;
    Jet* f = forces.data();
    if (drive_.prescribed()) {
        f[0] = driven ? drive_.motion(s.t.v).acceleration : 0;
    } else if (model_.coupled()) {
        for (int i = 0; i < modes_; ++i) f[0] -= (U[i] / mass) * f[1 + i];
        f[0] = f[0] / (inertia_ - U.squaredNorm() / mass);
    } else {
        f[0] = f[0] / inertia_;
    }
    for (int i = 0; i < modes_; ++i) {
        if (model_.coupled()) f[1 + i] -= U[i] * f[0];
        f[1 + i] = f[1 + i] / mass;
    }
}

// The disc of a contact turns with the cam. At an end of the beam the disc at the contact serves for a cam of any
// shape.
template <class T>
void ModalJets::place_disc(const T& psi, const ContactState& near, Frame<T>& frame) const {
    Vec2 arm{problem_.cam->eccentricity, 0};  // in the cam's frame
    frame.radius = problem_.cam->radius;
    if (!cam_.is_disc()) {
        const double alpha = std::atan2(near.normal.y, near.normal.x) - value_of(psi);
        const CamPoint at = cam_.shape().at(alpha);
        arm = at.position(alpha) - at.radius * unit(alpha);
        frame.radius = at.radius;
    }
    const T c = cos(psi), s = sin(psi), x = arm.x * c - arm.y * s, y = arm.x * s + arm.y * c;
    frame.disc_x = cam_.axis().x + x;
    frame.disc_y = cam_.axis().y + y;
    frame.disc_vx = cam_.speed() * y;
    frame.disc_vy = -cam_.speed() * x;
}

// The contact in a state of jets, or of jets that depend on time. The derivative of the foot is that of a step of
// Newton's method for r′·(r − B) = 0 (S24), and the mixed derivative that of another.
template <class T>
ContactKinematics<T> ModalJets::kinematics(const std::vector<T>& xi, const std::vector<T>& rate, const T& t,
                                           const ContactState& near, double gap_offset, std::vector<T>& hq) {
    const T psi = problem_.cam->phase - cam_.speed() * t;  // (S23)
    Frame<T> frame{sin(xi[0]), cos(xi[0]), rate[0]};
    frame.turned = xi[0] - psi;
    frame.osculating = !cam_.is_disc() && !near.at_end;
    if (!frame.osculating) place_disc(psi, near, frame);
    expansion_->centre_at(near.x);
    ContactKinematics<T> touch;
    const int corrections = near.at_end ? 0 : std::is_same_v<T, Jet> ? 1 : 2;
    expansion_->evaluate(xi.data() + 1, rate.data() + 1, frame, gap_offset, hq.data(), touch, corrections);
    return touch;
}

void ModalJets::place_hub(JetState& s) const {
    if (!drive_.prescribed()) return;
    const HubMotion hub = drive_.motion(s.t.v);
    s.xi[0] = chain(s.t, hub.angle, hub.rate);
    s.rate[0] = chain(s.t, hub.rate, hub.acceleration);
}

const ContactKinematics<Jet>& ModalJets::contact(JetState& s, const ContactState& near, double gap_offset) {
    place_hub(s);
    contact_ = kinematics(s.xi, s.rate, s.t, near, gap_offset, hq_);
    jn_[0] = contact_.hub;
    jt_[0] = contact_.hub_t;
    for (std::size_t i = 0; i + 1 < jn_.size(); ++i)
        expansion_->rows(contact_, hq_.data(), i, true, jn_[1 + i], jt_[1 + i]);
    return contact_;
}

// g̈ at ξ̈ = 0 (S44): the time derivative of the gap rate.
Jet ModalJets::gap_acceleration_at_rest(const JetState& s, const ContactState& near) {
    std::vector<JetRate> xi(s.xi.size()), rate(xi), hq(xi);
    for (std::size_t i = 0; i < xi.size(); ++i) {
        xi[i] = {s.xi[i], s.rate[i]};
        rate[i] = {s.rate[i], 0};
    }
    return kinematics(xi, rate, JetRate(s.t, 1), near, 0, hq).gap_rate.d;
}

// The normal force of sustained contact (S45), after `assemble` and `contact`.
Jet ModalJets::constraint_force(const JetState& s, const ContactState& near) {
    const Jet ratio = friction_.none() ? Jet() : friction_ratio();
    std::vector<Jet> free = force_, response(jn_);
    for (std::size_t i = 0; i < response.size(); ++i) response[i] = jn_[i] + ratio * jt_[i];
    solve(s, free, true);
    solve(s, response, false);
    Jet gap_acceleration = gap_acceleration_at_rest(s, near), per_newton;
    for (std::size_t i = 0; i < free.size(); ++i) {
        gap_acceleration += jn_[i] * free[i];
        per_newton += jn_[i] * response[i];
    }
    const Jet decay = baumgarte_rate_ * (2 * contact_.gap_rate + baumgarte_rate_ * (contact_.gap - contact_.gap.v));
    return -(decay + gap_acceleration) / per_newton;
}

Jet ModalJets::sliding_bristle(FrictionState state, const Forces& f) const {
    return (FrictionLaw::sign(state) * friction_.kinetic / friction_.stiffness) * f.normal;
}

// Friction as FrictionLaw::force.
ModalJets::Forces ModalJets::forces(JetState& s, const Phase& phase, const ContactState& near) {
    contact(s, near, phase.gap_offset);
    assemble(s);
    Forces f;
    f.slip = contact_.slip;
    if (phase.held) {
        f.normal = constraint_force(s, near);
    } else {
        const Jet &gap = contact_.gap, &rate = contact_.gap_rate, &approach = s.approach;
        const ForceAndSlopes law = law_.at(contact_.radius.v).linearized(-gap.v, -rate.v, approach.v);
        // δ̇ and δ̇₋ appear in (S30) as their quotient.
        f.normal = {law.force, -law.by_depth * gap.d - law.by_rate * (rate.d - (rate.v / approach.v) * approach.d)};
        if (law_.hertz_radius > 0) f.normal.d += (0.5 * law.force / contact_.radius.v) * contact_.radius.d;
    }
    if (friction_.none()) return f;
    if (!friction_.bristle)
        f.friction = friction_ratio() * f.normal;
    else if (phase.friction == FrictionState::stick)
        f.friction = -friction_.stiffness * s.bristle;
    else
        f.friction = (-FrictionLaw::sign(phase.friction) * friction_.kinetic) * f.normal;
    return f;
}

void ModalJets::flow(JetState& s, const Phase& phase, const ContactState& near, std::vector<Jet>& acceleration,
                     Jet& bristle_rate) {
    bristle_rate = 0;
    if (phase.touching) {
        const Forces f = forces(s, phase, near);
        for (std::size_t i = 0; i < force_.size(); ++i) force_[i] += f.normal * jn_[i] + f.friction * jt_[i];  // (S28)
        if (friction_.bristle && phase.friction == FrictionState::stick) bristle_rate = f.slip;
    } else {
        place_hub(s);
        assemble(s);
    }
    solve(s, force_, true);
    acceleration = force_;
}

// ξ̇ ← ξ̇ + M⁻¹(J_nᵀP_n + J_tᵀP_t)                                                                               (S43)
void ModalJets::apply_impact(JetState& s, const ContactState& near, double restitution) {
    contact(s, near);
    assemble(s);
    std::vector<Jet> by_n = jn_, by_t = jt_;
    solve(s, by_n, false);
    solve(s, by_t, false);
    ComplianceOf<Jet> compliance{0, 0, 0};
    for (std::size_t i = 0; i < force_.size(); ++i) {
        compliance.nn += jn_[i] * by_n[i];
        compliance.nt += 0.5 * (jt_[i] * by_n[i] + jn_[i] * by_t[i]);
        compliance.tt += jt_[i] * by_t[i];
    }
    const ImpactResultOf<Jet> impact = resolve_impact<Jet>(compliance, contact_.gap_rate, contact_.slip,
                                                           friction_.kinetic, restitution, problem_.contact.law);
    for (std::size_t i = 0; i < force_.size(); ++i)
        s.rate[i] += impact.impulse_n * by_n[i] + impact.impulse_t * by_t[i];
}

double ModalJets::inertia_share(const double* q) const {
    if (drive_.prescribed() || modes_ == 0) return 1;
    const ModalMatrices& m = model_.matrices();
    const Eigen::Map<const Eigen::VectorXd> coordinates(q, modes_);
    const double condensed = model_.coupled() ? m.U.squaredNorm() / model_.mass() : 0;
    return 1 + coordinates.dot(model_.inertia_matrix() * coordinates) / (m.J - condensed);
}

}  // namespace beamcam::sim
