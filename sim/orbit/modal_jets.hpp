// The equations of the modal models and of the contact in jets: the vector field, the gap and the resets at events,
// with their derivatives along tangents. MODEL.md (S70), (S71).
//
// The state is that of System (ξ, ξ̇, bristle deflection z) and the approach speed δ̇₋ of a compliant touch (S72). Covers
// the models rigid, zeroth-order and first-order in both bases; values agree with System to rounding.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sim/beam/modal_model.hpp"
#include "sim/dynamics/system.hpp"
#include "sim/integrate/contact_lanes.hpp"
#include "sim/orbit/jet.hpp"

namespace beamcam::sim {

struct JetState {
    // The state y of this system at time t, without derivatives.
    JetState(const System& system, double time, const double* y, const Phase& phase);
    Jet t;
    std::vector<Jet> xi, rate;
    Jet bristle, approach;
};

// All functions of a state set the angle and the rate of a prescribed hub in it. `near` is the contact at the value of
// the state.
class ModalJets {
  public:
    explicit ModalJets(System& system);  // copies what it needs

    // ξ̈ and ż in this phase. Of `near` only contact needs it.
    void flow(JetState& s, const Phase& phase, const ContactState& near, std::vector<Jet>& acceleration,
              Jet& bristle_rate);
    const ContactKinematics<Jet>& contact(JetState& s, const ContactState& near, double gap_offset = 0);
    struct Forces {
        Jet normal, friction, slip;
    };
    Forces forces(JetState& s, const Phase& phase, const ContactState& near);
    Jet sliding_bristle(FrictionState state, const Forces& f) const;  // deflection under the sliding force (S36)
    // s.rate ← ξ̇ after an impact with this restitution, by the problem's impact law and friction.
    void apply_impact(JetState& s, const ContactState& near, double restitution);

    // Ratio of volumes in (ξ, ∂T/∂ξ̇) and in (ξ, ξ̇), relative to its value at q = 0 (S73).
    double inertia_share(const double* q) const;

  private:
    template <class T>
    ContactKinematics<T> kinematics(const std::vector<T>& xi, const std::vector<T>& rate, const T& t,
                                    const ContactState& near, double gap_offset, std::vector<T>& hq);
    template <class T>
    void place_disc(const T& psi, const ContactState& near, Frame<T>& frame) const;
    void place_hub(JetState& s) const;
    Jet gap_acceleration_at_rest(const JetState& s, const ContactState& near);
    Jet constraint_force(const JetState& s, const ContactState& near);
    Jet friction_ratio() const { return -friction_.kinetic * tanh(contact_.slip / friction_.slip_speed); }
    void assemble(const JetState& s);
    void solve(const JetState& s, std::vector<Jet>& forces, bool driven) const;

    const Problem problem_;
    const ModalModel model_;  // tables
    const TurningCam cam_;
    const DriveLaw drive_;
    const NormalLaw law_;
    const FrictionLaw friction_;
    std::optional<ContactExpansion> expansion_;  // of a problem with a cam
    int n_, modes_;
    double baumgarte_rate_;

    // These belong to the present state.
    Jet inertia_;
    std::vector<Jet> force_;
    ContactKinematics<Jet> contact_;
    std::vector<Jet> jn_, jt_, hq_;  // rows of the contact, and scratch
};

}  // namespace beamcam::sim
