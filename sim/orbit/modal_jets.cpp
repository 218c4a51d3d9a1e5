#include "sim/orbit/modal_jets.hpp"

namespace beamcam::sim {
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
      q_(modes_),
      dq_(modes_),
      force_(n_),
      y_(modes_),
      y1_(modes_),
      y2_(modes_),
      y3_(modes_),
      shortening_matrix_(modes_, modes_),
      shape_(modes_),
      slope_(modes_),
      curve_(modes_),
      shortening_(modes_) {
    c_.jn = c_.jt = JetVector(n_);
    if (const std::vector<double> c = model_.damping_matrix(); !c.empty())
        damping_ = Eigen::Map<const Eigen::MatrixXd>(c.data(), modes_, modes_);
}

void ModalJets::set(const JetState& s) {
    Theta_ = s.xi[0];
    Theta_dot_ = s.rate[0];
    if (drive_.prescribed()) {
        const HubMotion hub = drive_.motion(s.t.v);
        Theta_ = chain(s.t, hub.angle, hub.rate);
        Theta_dot_ = chain(s.t, hub.rate, hub.acceleration);
    }
    sin_ = sin(Theta_);
    cos_ = cos(Theta_);
    alpha_ = alpha_dot_ = 0;
    for (int i = 0; i < modes_; ++i) {
        q_[i] = s.xi[1 + i];
        dq_[i] = s.rate[1 + i];
        alpha_ += model_.hub_row()[1 + i] * q_[i];
        alpha_dot_ += model_.hub_row()[1 + i] * dq_[i];
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
            bq += B(i, j) * q_[j];
            if (shortened) gq += m_.G(i, j) * q_[j];
        }
        if (damping_.size() > 0)
            for (int j = 0; j < modes_; ++j) damping += damping_(i, j) * dq_[j];
        coriolis += bq * dq_[i];
        qbq += bq * q_[i];
        wq += m_.W[i] * q_[i];
        qgq += gq * q_[i];
        force_[1 + i] =
            Theta_dot_ * Theta_dot_ * bq + g * (sin_ * gq) - m_.K[i] * q_[i] - (g * m_.W[i]) * cos_ - damping;
    }
    inertia_ = m_.J + qbq;
    force_[0] = -2 * (Theta_dot_ * coriolis) - g * (m_.S * cos_ - wq * sin_ - 0.5 * (cos_ * qgq));
    if (!drive_.has_torque()) return;
    const double torque = drive_.torque(s.t.v);
    for (int i = 0; i < n_; ++i) force_[i] += torque * model_.hub_row()[i];
}

// f ← M⁻¹f; a prescribed hub has its own acceleration if `driven`, else none.
void ModalJets::solve(const JetState& s, JetVector& f, bool driven) const {
    const double mass = model_.mass();
    if (drive_.prescribed()) {
        f[0] = driven ? drive_.motion(s.t.v).acceleration : 0;
    } else if (model_.coupled()) {
        Jet hub = f[0];
        for (int i = 0; i < modes_; ++i) hub -= (m_.U[i] / mass) * f[1 + i];
        f[0] = hub / (inertia_ - m_.U.squaredNorm() / mass);
    } else {
        f[0] = f[0] / inertia_;
    }
    for (int i = 0; i < modes_; ++i) {
        if (model_.coupled()) f[1 + i] -= m_.U[i] * f[0];
        f[1 + i] = f[1 + i] / mass;
    }
}

void ModalJets::flow(const JetState& s, const Phase& phase, const ContactState& near, JetVector& acceleration,
                     Jet& bristle_rate) {
    set(s);
    assemble(s);
    bristle_rate = 0;
    if (phase.touching) {
        contact(s, near);
        const Forces f = current_forces(s, phase, near.at_end);
        for (int i = 0; i < n_; ++i) force_[i] += f.normal * c_.jn[i] + f.friction * c_.jt[i];  // (S28)
        if (friction_.bristle && phase.friction == FrictionState::stick)
            bristle_rate = f.slip;
        else if (friction_.lags)
            bristle_rate = (friction_.stiffness / friction_.damping) * (sliding_bristle(phase.friction, f) - s.bristle);
    }
    solve(s, force_, true);
    acceleration = force_;
}

double ModalJets::inertia_share(const double* q) const {
    if (drive_.prescribed() || modes_ == 0) return 1;
    const Eigen::Map<const Eigen::VectorXd> coordinates(q, modes_);
    const double condensed = model_.coupled() ? m_.U.squaredNorm() / model_.mass() : 0;
    return 1 + coordinates.dot(model_.inertia_matrix() * coordinates) / (m_.J - condensed);
}

}  // namespace beamcam::sim
