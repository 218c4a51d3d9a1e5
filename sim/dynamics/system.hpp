// Beam, cam and contact as one first-order system of differential equations, which is smooth in each phase of the
// motion: flight, compliant contact (with the state of stick-slip friction), or sustained impulsive contact.
// MODEL.md §§7–10.
//
// State y: ξ (N+1), ξ̇ (N+1), bristle deflection z (stick-slip friction only); then the integrals of the energy balance,
// which take no part in error control, unless the motion is given.
#pragma once

#include <memory>

#include "sim/base/ode.hpp"
#include "sim/beam/drive.hpp"
#include "sim/beam/model.hpp"
#include "sim/contact/contact_law.hpp"
#include "sim/contact/impulse.hpp"
#include "sim/dynamics/contact_geometry.hpp"
#include "sim/dynamics/gap_bound.hpp"

namespace beamcam::sim {

// The integrals of the energy balance (S38).
enum Ledger : int {
    kLossStructural,
    kLossHub,
    kNormalWork,
    kFrictionWork,
    kWorkCam,
    kWorkDrive,
    kImpulseN,
    kImpulseT,
    kLedgerSize
};

struct Phase {
    bool touching = false;
    bool held = false;    // sustained impulsive contact: touching under the constraint of a zero gap (S45)
    double approach = 1;  // δ̇₋ of this touch, not below the approach floor [m/s]
    FrictionState friction = FrictionState::stick;
    double gap_offset = 0;  // added to the gap: cancels the rounding error at the last event [m]
};

class System final : public Ode {
  public:
    explicit System(const Problem& problem);
    System(const System& other);  // shares the constant tables

    void set_phase(const Phase& phase);
    const Phase& phase() const { return phase_; }
    void rhs(double t, const double* y, double* dy) override;

    bool has_cam() const { return problem_.cam.has_value(); }
    bool has_bristle() const { return friction_.bristle; }
    int coordinates() const { return n_; }
    double bristle(const double* y) const { return friction_.bristle ? y[2 * n_] : 0; }  // its deflection z [m]
    const TurningCam& cam() const { return cam_; }
    Model& model() { return *model_; }
    const DriveLaw& drive() const { return drive_; }
    const std::optional<HubSpring>& spring() const { return problem_.hub.spring; }
    // Of drive and spring on the hub, in the state of `set_state` [N m].
    double hub_torque(double t) const;
    const NormalLaw& normal_law() const { return law_; }
    const FrictionLaw& friction() const { return friction_; }
    const GapBound& gap_bound() const { return gap_bound_; }
    double offset() const { return offset_; }
    const Problem& problem() const { return problem_; }

    // Sets the state of the model, with θ and θ̇ of a prescribed drive.
    void set_state(double t, const double* y);
    // Contact geometry and, in contact, the forces of the present phase.
    ContactState contact(double t, const double* y);
    // The contact of the state of `set_state`.
    ContactState current_contact(double t, const double* y);
    // ∂g/∂ξ = ∂ġ/∂ξ̇ and ∂v_t/∂ξ̇ at the contact of the state of `set_state`; arrays of `coordinates` (S28).
    void contact_rows(const ContactState& c, double* jn, double* jt) const { geometry_.rows(*model_, c, jn, jt); }
    // The forces of compliant contact with this geometry.
    void add_forces(ContactState& c, const double* y) const;

    // After `contact`: f ← generalized forces in that state with the normal force `normal` [N] and its Coulomb
    // friction; array of `coordinates`. False if the inertia is not positive.
    bool generalized_force(double t, const ContactState& c, double normal, double* f);

    // Energies, losses and work; the total is constant (S38).
    struct EnergyBalance {
        Energies energies;
        double spring = 0;  // of the hub
        double contact = 0, loss_structural = 0, loss_hub = 0, loss_contact = 0, loss_friction = 0, work_cam = 0,
               work_drive = 0;
        double total() const {
            return energies.kinetic + energies.gravity + energies.elastic + spring + contact + loss_structural +
                   loss_hub + loss_contact + loss_friction - work_cam - work_drive;
        }
    };
    bool contact_stores_energy() const { return phase_.touching && (!phase_.held || has_bristle()); }
    // All but the energies of the beam and the hub's spring. Of the contact, if it stores energy, only the gap counts
    // and, with a bristle, the force.
    EnergyBalance balance_without_beam(const double* y, const ContactState& c) const;
    // ξ̈ in the state of `set_state`, in contact with the forces of `c`; array of `coordinates`. Returns the power of
    // the drive [W].
    double current_acceleration(double t, const ContactState& c, double* acc);

    double highest_frequency() const { return highest_frequency_; }
    // At which the outline of the cam comes back [rad/s]; zero for a disc that turns about its centre.
    double cam_rate() const { return cam_.shape().largest_slope() > 0 ? std::fabs(cam_.speed()) : 0; }
    // The largest damping ratio of a mode.
    double damping_ratio() const;
    double baumgarte_rate() const { return baumgarte_rate_; }  // of sustained contact (S45) [1/s]

    bool inertia_lost() const { return inertia_lost_; }
    // Impulsive contact: the response of the contact point to impulses, and the jump of ξ̇ and of the energy balance.
    Compliance compliance(double t, const double* y, const ContactState& c);
    void apply_impact(double t, double* y, const ContactState& c, const ImpactResult& impact);
    // ġ + κg, which decays at the rate κ in sustained contact (S45) [m/s].
    double off_constraint(double gap, double gap_rate) const { return gap_rate + baumgarte_rate_ * gap; }
    // Sustained contact: changes ξ̇ by the impulse of the contact that makes that `off`. Returns the contact before it.
    ContactState hold(double t, double off, double* y);
    // Lower bound of the time from touch to maximum penetration [s]: the undamped impact of the contact point's own
    // effective mass.
    double touch_time(double t, const double* y, const ContactState& c, double approach);
    // Acceleration of the gap without contact force [m/s²]; negative: the beam presses on the cam.
    double free_gap_acceleration(double t, const double* y);

    // The motion is a given function of time: that of a rigid beam on a prescribed hub.
    bool is_given() const { return n_ == 1 && drive_.prescribed(); }

    int ledger_at = 0;  // where the integrals begin in a state
    long gap_evaluations = 0;

  private:
    ContactState contact_geometry(double t);
    void add_torque(double t, double* f) const;
    void add_contact_force(const ContactState& c, double* f) const;
    double accelerate(double t, double* acc) const;
    void respond(double* f) const;
    double constrain(double t, ContactState& c, double* acc, bool with_force);
    double cam_power(const ContactState& c, double normal, double tangential) const;
    bool assemble(double* f);         // false if the inertia is not positive
    void require_inertia(double* f);  // the same, but throws InertiaLost

    Problem problem_;
    std::unique_ptr<Model> model_;
    DriveLaw drive_;
    TurningCam cam_;
    NormalLaw law_;
    FrictionLaw friction_;
    GapBound gap_bound_;
    ContactGeometry geometry_;
    Phase phase_;
    int n_ = 1;
    double offset_ = 0, highest_frequency_ = 0;
    double baumgarte_rate_ = 0, free_gap_acceleration_ = 0;
    bool inertia_lost_ = false;
};

}  // namespace beamcam::sim
