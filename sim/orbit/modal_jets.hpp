// The equations of the modal models and of the contact, written in jets: the vector field, the gap and the resets of
// events with their derivatives along tangents. MODEL.md §16a.
//
// Coordinates are those of System: ξ, ξ̇, the bristle's deflection z, and the approach speed δ̇₋ that a compliant touch
// keeps (S72). Covers rigid, zeroth-order and first-order in both bases; values agree with System to rounding.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/beam/modal_model.hpp"
#include "sim/dynamics/system.hpp"
#include "sim/orbit/jet.hpp"

namespace beamcam::sim {

struct JetState {
    explicit JetState(int coordinates)
        : xi(static_cast<std::size_t>(coordinates)), rate(static_cast<std::size_t>(coordinates)) {}
    Jet t;
    std::vector<Jet> xi, rate;
    Jet bristle, approach = 1;
};

// Nothing where the model is covered, else why not.
std::optional<std::string> tangent_refusal(const Problem& problem);

class ModalJets {
  public:
    // `system` is of the problem; it is not kept.
    explicit ModalJets(System& system);

    // ξ̈ and ż in this phase. `near`: the contact at the value of the state, where it touches.
    void flow(const JetState& s, const Phase& phase, const ContactState& near, std::vector<Jet>& acceleration,
              Jet& bristle_rate);
    // Gap and its rate.
    struct Gap {
        Jet gap, rate;
    };
    Gap gap(const JetState& s, const ContactState& near);
    // Of the contact evaluated last: where its foot is along the beam; beyond an end, where the straight continuation
    // has it [m].
    double foot(const ContactState& near) const;
    // Of a contact that lasts.
    struct Forces {
        Jet normal, friction, slip;
    };
    Forces forces(const JetState& s, const Phase& phase, const ContactState& near);
    Jet sliding_bristle(Grip grip, const Forces& f) const;  // deflection that carries the sliding force (S36)
    // ξ̇ after a strike with this restitution, by the problem's law and friction, in place.
    void strike(JetState& s, const ContactState& near, double restitution);

    // What the volume of (ξ, ξ̇) must be multiplied with to be that of (ξ, ∂T/∂ξ̇), over its value at q = 0.
    double inertia_share(const double* q) const;

  private:
    // The centre line at the contact and how it answers.
    struct Contact {
        Jet2 r, r1, r2, v, v1, normal, along;
        Jet distance, gap_rate, slip, bend;
        std::vector<Jet> jn, jt;
    };
    void set(const JetState& s);
    void line(const Jet& x);
    void contact(const JetState& s, const ContactState& near);
    void assemble(const JetState& s);
    void solve(const JetState& s, std::vector<Jet>& f, bool driven) const;
    Forces placed_forces(const JetState& s, const Phase& phase, bool at_end);
    Jet hold(const JetState& s, bool at_end);
    Jet friction_ratio() const;

    const Problem problem_;
    const ModalModel model_;  // tables
    const ModalMatrices& m_;
    const DriveLaw drive_;
    const NormalLaw law_;
    const FrictionLaw friction_;
    int n_, modes_;
    double offset_, baumgarte_rate_;
    std::vector<double> damping_;  // C_d, N² column-major; empty: none

    // Of the state that was set.
    Jet sin_, cos_, spin_, angle_, turn_, turn_rate_, inertia_;
    std::vector<Jet> q_, dq_, bq_, force_;
    Contact c_;
    std::vector<double> y_, y1_, y2_, y3_, h_;
    std::vector<Jet> shape_, slope_, curve_, shortening_;
};

}  // namespace beamcam::sim
