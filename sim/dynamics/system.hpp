// Beam, cam and contact together, as one first-order system in each phase of the motion: flight, or
// touching (with the grip of stick-slip friction). MODEL.md §§7–10.
//
// State y: ξ (N+1), ξ̇ (N+1), bristle deflection z (stick-slip only); then the integrals of the
// energy ledger, which error control does not see.
#pragma once

#include <memory>
#include <optional>

#include "sim/base/ode.hpp"
#include "sim/beam/drive.hpp"
#include "sim/beam/model.hpp"
#include "sim/contact/friction.hpp"
#include "sim/contact/impulse.hpp"
#include "sim/dynamics/contact_geometry.hpp"
#include "sim/dynamics/gap_bound.hpp"

namespace beamcam::sim {

// Integrals kept beside the state.
enum Ledger : int {
    kLossStructural,
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
    bool held = false;    // touching under a constraint (model `restitution`), not by penetration
    double approach = 1;  // δ̇₋ of this touch, floored [m/s]
    Grip grip = Grip::stick;
    double gap_offset = 0;  // rounding left by the last event, taken out of the gap [m]
};

class System final : public Ode {
  public:
    explicit System(const Problem& problem);
    // Another observer of the same problem: tables are shared, the state is its own.
    System(const System& other);

    // The next evaluation of the contact searches the whole beam.
    void set_phase(const Phase& phase) {
        phase_ = phase;
        search_again();
    }
    void search_again() { geometry_.search_again(); }
    // The next one begins at this x, near which the foot is known to be.
    void begin_contact_at(double x) { geometry_.begin_at(x); }
    const Phase& phase() const { return phase_; }
    void rhs(double t, const double* y, double* dy) override;

    bool has_cam() const { return problem_.cam.has_value(); }
    bool has_bristle() const { return friction_.bristle; }
    int coordinates() const { return n_; }
    CamPose cam(double t) const { return cam_pose(*problem_.cam, t); }
    Model& model() { return *model_; }
    const DriveLaw& drive() const { return drive_; }
    const NormalLaw& normal_law() const { return law_; }
    const FrictionLaw& friction() const { return friction_; }
    const GapBound& gap_bound() const { return gap_bound_; }
    double offset() const { return offset_; }
    const Problem& problem() const { return problem_; }

    // Puts (t, y) into the model (with θ as the drive prescribes it).
    void place(double t, const double* y);
    // Contact geometry, and forces of `phase_` if it touches. `search`: over the whole beam, else near
    // the foot found last.
    ContactState contact(double t, const double* y, bool search);
    // The same after `place`.
    ContactState contact_placed(double t, const double* y, bool search);

    // After `contact`: forces and torque at that state with the cam pushing by `normal` [N] along n, and by the
    // Coulomb friction that goes with it along t; array of `coordinates`. False when the inertia that would answer is
    // not positive.
    bool generalized_force(double t, const ContactState& c, double normal, double* f);

    // Energies and what the ledger says of losses and work at (t, y); the total must stay constant.
    struct EnergyBalance {
        Energies energies;
        double contact = 0, loss_structural = 0, loss_contact = 0, loss_friction = 0, work_cam = 0, work_drive = 0;
        double total() const {
            return energies.kinetic + energies.gravity + energies.elastic + contact + loss_structural + loss_contact +
                   loss_friction - work_cam - work_drive;
        }
    };
    EnergyBalance energy_balance(double t, const double* y);
    // The same in contact without friction's bristle, where the gap is known.
    EnergyBalance energy_balance(double t, const double* y, double gap);
    // ξ̈ at (t, y) in the present phase; array of `coordinates`.
    void acceleration(double t, const double* y, double* acc);
    // The same after `place`, in flight or with the forces of the contact that is known.
    void acceleration_placed(double t, const ContactState& c, double* acc);

    double highest_frequency() const { return highest_frequency_; }
    double baumgarte_rate() const { return baumgarte_rate_; }  // of sustained contact (S45) [1/s]

    bool inertia_lost() const { return inertia_lost_; }
    // Impulsive contact: how the contact point answers, and the jump of ξ̇ and of the ledger in y.
    Compliance compliance(double t, const double* y, const ContactState& c);
    void strike(double t, double* y, const ContactState& c, const ImpactResult& impact);
    // How long a touch at this approach speed takes to reach its deepest point, at least [s]: Hertz impact of
    // the contact point's own compliance.
    double touch_time(double t, const double* y, const ContactState& c, double approach);
    // Rate of the gap's rate if nothing pushed: < 0 presses on the cam [m/s²].
    double free_gap_acceleration(double t, const double* y);

    long gap_evaluations = 0;

  private:
    double bristle(const double* y) const { return friction_.bristle ? y[2 * n_] : 0; }
    ContactState contact_geometry(double t, bool search);
    void contact_rows(const ContactState& c, double* jn, double* jt) const { geometry_.rows(*model_, c, jn, jt); }
    void add_torque(double t, double* f) const;
    double accelerate(double t, double* acc) const;
    void respond(double* f) const;
    double hold(double t, ContactState& c, double* acc, bool pushed);
    double cam_power(double t, const ContactState& c, double normal, double tangential) const;
    // Forces and inertia of the model; false when the inertia that must answer is not positive.
    bool assemble(double* f);
    // The same, but throws InertiaLost.
    void require_inertia(double* f);
    EnergyBalance mechanical_balance(double t, const double* y);

    Problem problem_;
    std::unique_ptr<Model> model_;
    DriveLaw drive_;
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
