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
#include "sim/contact/contact_law.hpp"
#include "sim/contact/impulse.hpp"
#include "sim/problem/problem.hpp"

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

// stick-slip friction: sticking, or sliding towards +t or −t.
enum class Grip { stick, slide_plus, slide_minus };

struct Phase {
    bool touching = false;
    bool held = false;    // touching under a constraint (model `restitution`), not by penetration
    double approach = 1;  // δ̇₋ of this touch, floored [m/s]
    Grip grip = Grip::stick;
    double gap_offset = 0;  // rounding left by the last event, taken out of the gap [m]
};

// The gap is known to a tenth of this share of the beam's length: what opens or falls no further is rounding.
inline constexpr double kGapRounding = 1e-14;

// Where the cam is.
struct CamPose {
    double angle = 0;  // ψ [rad]
    Vec2 disc;         // B [m]
    Vec2 velocity;     // Ḃ [m/s]
};

// The beam against the cam at one state; everything of MODEL.md §7.
struct ContactState {
    double x = 0;  // x_c [m]
    bool at_end = false;
    Vec2 normal, tangent;
    double gap = 0, gap_rate = 0;  // [m], [m/s]
    double slip = 0;               // v_t [m/s]
    double force = 0;              // N [N]
    double friction = 0;           // F_t on the beam along t [N]
    double factor = 1;             // 1 + D δ̇/δ̇₋ (clamp where negative)
};

class System final : public Ode {
  public:
    explicit System(const Problem& problem);
    // Another observer of the same problem: tables are shared, the state is its own.
    System(const System& other);

    // The next look at the contact searches the whole beam.
    void set_phase(const Phase& phase) {
        phase_ = phase;
        search_next_ = true;
    }
    void search_again() { search_next_ = true; }
    const Phase& phase() const { return phase_; }
    void rhs(double t, const double* y, double* dy) override;

    bool has_cam() const { return problem_.cam.has_value(); }
    bool has_bristle() const { return bristle_; }
    int coordinates() const { return n_; }
    CamPose cam(double t) const;
    Model& model() { return *model_; }
    const DriveLaw& drive() const { return drive_; }
    const NormalLaw& normal_law() const { return law_; }
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

    // Energy books at (t, y). Total = what the ledger says must stay constant.
    struct Books {
        Energies energies;
        double contact = 0, loss_structural = 0, loss_contact = 0, loss_friction = 0, work_cam = 0, work_drive = 0;
        double total() const {
            return energies.kinetic + energies.gravity + energies.elastic + contact + loss_structural + loss_contact +
                   loss_friction - work_cam - work_drive;
        }
    };
    Books books(double t, const double* y);
    // The same in contact without friction's bristle, where the gap is known.
    Books books(double t, const double* y, double gap);
    // ξ̈ at (t, y) in the present phase; array of `coordinates`.
    void acceleration(double t, const double* y, double* acc);

    // Bristle deflection that carries the sliding force: where z is put at slip (S36).
    double sliding_bristle(const ContactState& contact) const;
    // Where z is put when sliding ends: spring and dashpot go on with that force.
    double caught_bristle(const ContactState& contact) const;
    // Speed of the bristle's foot over the cam in the direction of sliding, v_t − ż. A bristle with a
    // dashpot lags behind its force; only then is z a state while sliding (S36), and only when the lag is no mere
    // trifle of a contact's time.
    double foot_speed(const double* y, const ContactState& contact) const;
    bool bristle_lags() const { return bristle_lags_; }
    bool bristle_damped() const { return bristle_damping_ > 0; }
    double bristle_stiffness() const { return bristle_stiffness_; }
    double static_coefficient() const { return mu_static_; }
    double kinetic_coefficient() const { return mu_; }

    // The gap is at least this [m].
    double gap_lower_bound(double t, const double* y) const;
    // The same at all instants up to h from t, with coordinates up to `spread` from ξ.
    double gap_lower_bound(double t, double h, const double* xi, const double* spread) const;
    // How far apart two places of a point of the beam are at most, for coordinates that differ by `change` [m]; to
    // first order in the deflection.
    double travel_bound(const double* change) const;
    // Only one foot exists for these coordinates q, wherever the disc is.
    bool nearly_straight(const double* q) const;
    // Of mode i: bounds of its shape as Shapes::bound has them, and its wave number. Not for `exact`.
    double shape_bound(int i) const { return shape_bounds_[static_cast<std::size_t>(i)]; }
    double wave_number(int i) const { return wave_numbers_[static_cast<std::size_t>(i)]; }
    double highest_frequency() const { return highest_frequency_; }

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
    Vec2 foot(Vec2 disc, bool search, ContactState& c);
    double friction_force(const double* y, ContactState& c) const;
    ContactState contact_geometry(double t, bool search);
    void add_torque(double t, double* f) const;
    double move(double t, double* acc) const;
    void contact_rows(const ContactState& c, double* jn, double* jt) const;
    double gap_acceleration_at_rest(double t, const ContactState& c) const;
    void respond(double* f) const;
    double hold(double t, ContactState& c, double* acc, bool pushed);
    double bristle_rate(const double* y, const ContactState& c) const;
    // Forces and inertia of the model; false when the inertia that must answer is not positive.
    bool assemble(double* f);
    // The same, but throws InertiaLost.
    void require_inertia(double* f);
    double deflection_bound(const double* xi, const double* spread) const;
    Books open_books(double t, const double* y);

    Problem problem_;
    std::unique_ptr<Model> model_;
    DriveLaw drive_;
    NormalLaw law_;
    Phase phase_;
    int n_ = 1;
    bool bristle_ = false, bristle_lags_ = false;
    double offset_ = 0;
    double mu_ = 0, mu_static_ = 0, slip_speed_ = 1e-3, bristle_stiffness_ = 0, bristle_damping_ = 0;
    double highest_frequency_ = 0;
    std::vector<double> shape_bounds_, wave_numbers_;  // empty for `exact`
    double x_last_ = 0;
    double settle_ = 0, free_gap_acceleration_ = 0;
    double answer_[kMaxSize] = {};
    BeamPoint at_;
    bool inertia_lost_ = false, search_next_ = true;
};

}  // namespace beamcam::sim
