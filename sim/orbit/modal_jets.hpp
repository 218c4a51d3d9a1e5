// The equations of the modal models and of the contact in jets: the vector field, the gap and the resets at events,
// with their derivatives along tangents. MODEL.md (S70), (S71).
//
// The state is that of System (ξ, ξ̇, bristle deflection z) and the approach speed δ̇₋ of a compliant touch (S72). Covers
// the models rigid, zeroth-order and first-order in both bases; values agree with System to rounding.
#pragma once

#include <Eigen/Core>

#include "sim/beam/modal_model.hpp"
#include "sim/dynamics/system.hpp"
#include "sim/orbit/jet.hpp"

namespace beamcam::sim {

struct JetState {
    explicit JetState(int coordinates) : xi(coordinates), rate(coordinates) {}
    Jet t;
    JetVector xi, rate;
    Jet bristle, approach = 1;
};

class ModalJets {
  public:
    explicit ModalJets(System& system);  // copies what it needs

    // ξ̈ and ż in this phase. In contact `near` is the contact at the value of the state.
    void flow(const JetState& s, const Phase& phase, const ContactState& near, JetVector& acceleration,
              Jet& bristle_rate);
    // Gap and its rate.
    struct Gap {
        Jet gap, rate;
    };
    Gap gap(const JetState& s, const ContactState& near);
    // Position of the last evaluated contact's foot along the beam; beyond an end, on its straight extension [m].
    double foot(const ContactState& near) const;
    struct Forces {
        Jet normal, friction, slip;
    };
    Forces forces(const JetState& s, const Phase& phase, const ContactState& near);
    Jet sliding_bristle(FrictionState state, const Forces& f) const;  // deflection under the sliding force (S36)
    // s.rate ← ξ̇ after an impact with this restitution, by the problem's impact law and friction.
    void apply_impact(JetState& s, const ContactState& near, double restitution);

    // Ratio of volumes in (ξ, ∂T/∂ξ̇) and in (ξ, ξ̇), relative to its value at q = 0 (S73).
    double inertia_share(const double* q) const;

  private:
    // The centre line at the contact, and the rows of the contact forces.
    struct Contact {
        Jet2 r, r1, r2, v, v1, normal, along;
        Jet distance, gap_rate, slip, bend;
        JetVector jn, jt;
    };
    void set(const JetState& s);
    void line(const Jet& x);
    void contact(const JetState& s, const ContactState& near);
    void assemble(const JetState& s);
    void solve(const JetState& s, JetVector& f, bool driven) const;
    Forces current_forces(const JetState& s, const Phase& phase, bool at_end);
    Jet constraint_force(const JetState& s, bool at_end);
    Jet friction_ratio() const;

    const Problem problem_;
    const ModalModel model_;  // tables
    const ModalMatrices& m_;
    const DriveLaw drive_;
    const NormalLaw law_;
    const FrictionLaw friction_;
    int n_, modes_;
    double offset_, baumgarte_rate_;
    Eigen::MatrixXd damping_;  // C_d; empty: none

    // Of the present state.
    Jet sin_, cos_, Theta_dot_, Theta_, alpha_, alpha_dot_, inertia_;
    JetVector q_, dq_, force_;
    Contact c_;
    Eigen::VectorXd y_, y1_, y2_, y3_;
    Eigen::MatrixXd shortening_matrix_;  // H (S5a)
    JetVector shape_, slope_, curve_, shortening_;
};

}  // namespace beamcam::sim
