#include "sim/dynamics/system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/assert.hpp"

namespace beamcam::sim {
namespace {

// Baumgarte rate: kDecayOfVibration of the lowest bending frequency or, of a rigid beam, kDecayOfPendulum of √(g/L). So
// it is slower than vibration and faster than the pendulum.
constexpr double kDecayOfVibration = 0.1, kDecayOfPendulum = 10;
constexpr double kLeastGravity = 1e-3;   // [m/s²] keeps that rate above zero
constexpr double kLongestCamTurn = 0.1;  // [rad] of a cam with a profile, whose segments may be as short

// Of a cam with a profile, Hertz's stiffness is that of its largest radius of curvature.
NormalLaw normal_law_of(const Problem& problem, const TurningCam& cam) {
    NormalLaw law{contact_stiffness(problem), contact_exponent(problem),
                  damping_factor(problem.contact.damping, problem.contact.restitution)};
    if (cam.is_disc() || problem.contact.stiffness || is_line_contact(problem)) return law;
    law.hertz_radius = problem.cam->radius;
    law = law.at(cam.shape().largest_radius());
    law.hertz_radius = cam.shape().largest_radius();
    return law;
}

}  // namespace

System::System(const Problem& problem)
    : problem_(problem),
      model_(make_model(problem)),
      drive_(problem.hub.drive, problem.initial.angle),
      cam_(problem),
      law_(normal_law_of(problem, cam_)),
      friction_(FrictionLaw::of(problem, law_, model_->mass())),
      gap_bound_(problem, *model_, cam_),
      geometry_(problem, *model_, cam_),
      n_(model_->size()),
      offset_(contact_offset(problem)) {
    ledger_at = 2 * n_ + (has_bristle() ? 1 : 0);
    size = ledger_at + kLedgerSize;
    set_phase({});
    if (problem.cam && problem.cam->profile && cam_.speed() != 0)
        longest_step = kLongestCamTurn / std::fabs(cam_.speed());
    for (int i = 0; i + 1 < n_; ++i) highest_frequency_ = std::max(highest_frequency_, model_->frequency(i));
    baumgarte_rate_ =
        n_ > 1 ? kDecayOfVibration * model_->frequency(0)
               : kDecayOfPendulum * std::sqrt(std::max(kLeastGravity, std::fabs(problem.gravity)) / model_->length());
}

// The cam gives the motion of a rigid beam that follows it.
void System::set_phase(const Phase& phase) {
    phase_ = phase;
    controlled = is_given() || (n_ == 1 && phase.held) ? size : ledger_at;
}

System::System(const System& other)
    : Ode(other),
      ledger_at(other.ledger_at),
      problem_(other.problem_),
      model_(other.model_->clone()),
      drive_(other.drive_),
      cam_(other.cam_),
      law_(other.law_),
      friction_(other.friction_),
      gap_bound_(other.gap_bound_),
      geometry_(other.geometry_),
      phase_(other.phase_),
      n_(other.n_),
      offset_(other.offset_),
      highest_frequency_(other.highest_frequency_),
      baumgarte_rate_(other.baumgarte_rate_) {}

double System::damping_ratio() const {
    double ratio = 0.5 * problem_.beam.kelvin_voigt.value_or(0) * highest_frequency_;
    for (const double z : problem_.beam.damping_ratio) ratio = std::max(ratio, z);
    return ratio;
}

void System::set_state(double t, const double* y) {
    if (!drive_.prescribed()) {
        model_->set(y, y + n_);
        return;
    }
    double xi[kMaxSize], rate[kMaxSize];
    std::copy_n(y, n_, xi);
    std::copy_n(y + n_, n_, rate);
    const HubMotion hub = drive_.motion(t);
    xi[0] = hub.angle;
    rate[0] = hub.rate;
    model_->set(xi, rate);
}

ContactState System::contact(double t, const double* y) {
    set_state(t, y);
    return current_contact(t, y);
}

ContactState System::contact_geometry(double t) {
    BEAMCAM_ASSERT(has_cam());
    ++gap_evaluations;
    return geometry_.evaluate(*model_, gap_bound_, t, phase_.gap_offset);
}

ContactState System::current_contact(double t, const double* y) {
    ContactState c = contact_geometry(t);
    if (phase_.held) {
        double acc[kMaxSize];
        require_inertia(acc);
        add_torque(t, acc);
        constrain(t, c, acc, true);
    } else if (phase_.touching) {
        add_forces(c, y);
    }
    return c;
}

void System::add_forces(ContactState& c, const double* y) const {
    c.factor = law_.factor(-c.gap_rate, phase_.approach);
    c.force = law_.at(c.disc.radius).force(-c.gap, -c.gap_rate, phase_.approach);
    c.friction = friction_.force(phase_.friction, c.force, c.slip, bristle(y));
}

// With a prescribed hub only the inertia of the beam matters, which is always positive.
bool System::assemble(double* f) { return model_->assemble(f) || drive_.prescribed(); }

void System::require_inertia(double* f) {
    if (!assemble(f)) throw InertiaLost();
}

void System::rhs(double t, const double* y, double* dy) {
    set_state(t, y);
    double* acc = dy + n_;
    std::fill(dy, dy + size, 0.0);
    double* ledger = dy + ledger_at;
    if (!assemble(acc)) {
        inertia_lost_ = true;
        std::fill(dy, dy + size, std::numeric_limits<double>::quiet_NaN());
        return;
    }
    inertia_lost_ = false;
    ledger[kLossStructural] = model_->damping_power();
    if (spring()) ledger[kLossHub] = spring()->damping * model_->hub_rate() * model_->hub_rate();
    add_torque(t, acc);
    if (drive_.has_torque()) ledger[kWorkDrive] = drive_.torque(t) * model_->hub_rate();
    ContactState c;
    if (phase_.held) {
        c = contact_geometry(t);
        ledger[kWorkDrive] += constrain(t, c, acc, true);
    } else if (phase_.touching) {
        c = current_contact(t, y);
        add_contact_force(c, acc);
        if (has_bristle()) dy[2 * n_] = phase_.friction == FrictionState::stick ? c.slip : 0;
    }
    if (!phase_.held) ledger[kWorkDrive] += accelerate(t, acc);
    if (phase_.touching) {
        ledger[kNormalWork] = -c.force * c.gap_rate;
        ledger[kFrictionWork] = -c.friction * c.slip;
        ledger[kWorkCam] = cam_power(c, c.force, c.friction);
        ledger[kImpulseN] = c.force;
        ledger[kImpulseT] = c.friction;
    }
    std::copy(y + n_, y + 2 * n_, dy);
    if (drive_.prescribed()) dy[0] = drive_.motion(t).rate;
}

// acc ← ξ̈ from generalized forces. Returns the power of a prescribed drive.
double System::accelerate(double t, double* acc) const {
    if (!drive_.prescribed()) {
        model_->solve(acc);
        return 0;
    }
    const HubMotion hub = drive_.motion(t);
    return model_->solve_held(acc, hub.acceleration) * hub.rate;
}

// f ← M⁻¹ f; a prescribed hub does not respond.
void System::respond(double* f) const {
    if (drive_.prescribed())
        model_->solve_held(f, 0);
    else
        model_->solve(f);
}

// Power of the cam's motion for contact forces, or its work for impulses (S28).
double System::cam_power(const ContactState& c, double normal, double tangential) const {
    return normal * dot(c.normal, c.disc.velocity) +
           tangential * (dot(c.tangent, c.disc.velocity) + cam_.speed() * c.disc.radius);
}

// Sustained contact: the normal force λ that keeps g = ġ = 0, with the friction −μλ tanh(v_t/v_s) (S45).
// acc: generalized forces in, ξ̈ out. Without `with_force` λ = 0. Returns the power of a prescribed drive.
double System::constrain(double t, ContactState& c, double* acc, bool with_force) {
    double jn[kMaxSize], jt[kMaxSize], row[kMaxSize], minv_row[kMaxSize], free[kMaxSize];
    contact_rows(c, jn, jt);
    const double ratio = friction_.ratio(c.slip);
    for (int i = 0; i < n_; ++i) row[i] = jn[i] + ratio * jt[i];
    std::copy_n(row, n_, minv_row);
    std::copy_n(acc, n_, free);
    accelerate(t, free);
    respond(minv_row);
    double gap_acceleration = geometry_.gap_acceleration_at_rest(*model_, t, c), per_newton = 0;
    for (int i = 0; i < n_; ++i) {
        gap_acceleration += jn[i] * free[i];
        per_newton += jn[i] * minv_row[i];
    }
    // Rounding errors of g and ġ decay at this rate (Baumgarte 1972).
    const double target = -2 * baumgarte_rate_ * c.gap_rate - baumgarte_rate_ * baumgarte_rate_ * c.gap;
    c.force = with_force ? (target - gap_acceleration) / per_newton : 0;
    c.friction = ratio * c.force;
    free_gap_acceleration_ = gap_acceleration;
    for (int i = 0; i < n_; ++i) acc[i] += c.force * row[i];
    return accelerate(t, acc);
}

double System::free_gap_acceleration(double t, const double* y) {
    double acc[kMaxSize];
    set_state(t, y);
    require_inertia(acc);
    add_torque(t, acc);
    ContactState c = contact_geometry(t);
    constrain(t, c, acc, false);
    return free_gap_acceleration_;
}

double System::hub_torque(double t) const {
    const double driven = drive_.has_torque() ? drive_.torque(t) : 0;
    return spring() ? driven + spring()->torque(model_->hub_angle(), model_->hub_rate()) : driven;
}

void System::add_torque(double t, double* f) const {
    if (!drive_.has_torque() && !spring()) return;
    const double torque = hub_torque(t);
    for (int i = 0; i < n_; ++i) f[i] += torque * model_->hub_row()[i];
}

// (S28)
void System::add_contact_force(const ContactState& c, double* f) const {
    double jn[kMaxSize], jt[kMaxSize];
    contact_rows(c, jn, jt);
    for (int i = 0; i < n_; ++i) f[i] += c.force * jn[i] + c.friction * jt[i];
}

bool System::generalized_force(double t, const ContactState& c, double normal, double* f) {
    double jn[kMaxSize], jt[kMaxSize];
    const bool positive = assemble(f);
    add_torque(t, f);
    contact_rows(c, jn, jt);
    const double ratio = has_bristle() ? 0 : friction_.ratio(c.slip);
    for (int i = 0; i < n_; ++i) f[i] += normal * (jn[i] + ratio * jt[i]);
    return positive;
}

System::EnergyBalance System::balance_without_beam(const double* y, const ContactState& c) const {
    const double* ledger = y + ledger_at;
    double normal = 0, bristle_energy = 0;
    if (phase_.touching) {
        normal = phase_.held ? 0 : law_.at(c.disc.radius).stored_energy(-c.gap);
        if (has_bristle()) {
            const bool sticks = phase_.friction == FrictionState::stick;
            const double z = sticks ? y[2 * n_] : friction_.sliding_bristle(phase_.friction, c.force);
            bristle_energy = 0.5 * friction_.stiffness * z * z;
        }
    }
    // The work done on the contact is stored or lost (S38).
    EnergyBalance b;
    b.contact = normal + bristle_energy;
    b.loss_structural = ledger[kLossStructural];
    b.loss_hub = ledger[kLossHub];
    b.loss_contact = ledger[kNormalWork] - normal;
    b.loss_friction = ledger[kFrictionWork] - bristle_energy;
    b.work_cam = ledger[kWorkCam];
    b.work_drive = ledger[kWorkDrive];
    return b;
}

double System::current_acceleration(double t, const ContactState& c, double* acc) {
    require_inertia(acc);
    add_torque(t, acc);
    if (phase_.touching) add_contact_force(c, acc);
    const double of_torque = drive_.has_torque() ? drive_.torque(t) * model_->hub_rate() : 0;
    return of_torque + accelerate(t, acc);
}

}  // namespace beamcam::sim
