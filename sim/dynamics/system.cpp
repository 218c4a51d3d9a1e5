#include "sim/dynamics/system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/beam/shapes.hpp"

namespace beamcam::sim {
namespace {

// A bristle that relaxes faster than this share of the time to the deepest point of an impact at 1 m/s has
// relaxed, as far as an impact can tell: following it would cost a thousand steps a contact and more.
constexpr double kShortestLag = 1e-3;
constexpr double kLeastShapeBound = 3;  // of Shapes::bound: all shapes of a beam that does not reach beyond its hinge

}  // namespace

System::System(const Problem& problem)
    : problem_(problem), model_(make_model(problem)), drive_(problem.hub.drive, problem.initial.angle) {
    n_ = model_->size();
    law_ = {contact_stiffness(problem), problem.contact.exponent,
            damping_factor(problem.contact.damping, problem.contact.restitution)};
    offset_ = contact_offset(problem);
    if (const auto* friction = std::get_if<CoulombFriction>(&problem.contact.friction)) {
        mu_ = mu_static_ = friction->coefficient;
        slip_speed_ = friction->slip_speed;
    } else if (const auto* grip = std::get_if<StickSlipFriction>(&problem.contact.friction)) {
        bristle_ = problem.cam.has_value() && problem.contact.model == ContactModel::compliant;
        mu_ = grip->coefficient;
        mu_static_ = std::max(mu_, grip->static_coefficient.value_or(mu_));
        // Mindlin's ratio of tangential to normal stiffness, 2(1−ν)/(2−ν), times the normal stiffness
        // n K δⁿ⁻¹ at the penetration that the beam's mass reaches at 1 m/s (S37).
        const double n = law_.exponent, nu = problem.beam.poisson_ratio;
        const double depth = std::pow(0.5 * (n + 1) * model_->mass() / law_.stiffness, 1 / (n + 1));
        bristle_stiffness_ =
            grip->stiffness.value_or(2 * (1 - nu) / (2 - nu) * n * law_.stiffness * std::pow(depth, n - 1));
        bristle_damping_ = grip->damping.value_or(0);
        bristle_lags_ = bristle_damping_ / bristle_stiffness_ > kShortestLag * depth;  // depth: of 1 m/s, [s m/s]
    }
    controlled = 2 * n_ + (bristle_ ? 1 : 0);
    size = controlled + kLedgerSize;
    for (int i = 0; i + 1 < n_; ++i) highest_frequency_ = std::max(highest_frequency_, model_->frequency(i));
    x_last_ = 0.5 * model_->length();
    if (n_ > 1 && problem.beam.model != ModelKind::exact) {
        const Shapes shapes = Shapes::of(problem);
        for (int i = 0; i + 1 < n_; ++i) {
            shape_bounds_.push_back(std::max(kLeastShapeBound, shapes.bound(i)));
            wave_numbers_.push_back(shapes.beta(i));
        }
    }
    // Slower than the lowest vibration, or than the swing of a rigid beam.
    settle_ = n_ > 1 ? 0.1 * model_->frequency(0)
                     : 10 * std::sqrt(std::max(1e-3, std::fabs(problem.gravity)) / model_->length());
}

System::System(const System& other)
    : Ode(other),
      problem_(other.problem_),
      model_(other.model_->clone()),
      drive_(other.drive_),
      law_(other.law_),
      phase_(other.phase_),
      n_(other.n_),
      bristle_(other.bristle_),
      bristle_lags_(other.bristle_lags_),
      offset_(other.offset_),
      mu_(other.mu_),
      mu_static_(other.mu_static_),
      slip_speed_(other.slip_speed_),
      bristle_stiffness_(other.bristle_stiffness_),
      bristle_damping_(other.bristle_damping_),
      highest_frequency_(other.highest_frequency_),
      shape_bounds_(other.shape_bounds_),
      wave_numbers_(other.wave_numbers_),
      x_last_(other.x_last_),
      settle_(other.settle_) {}

CamPose System::cam(double t) const {
    const Cam& cam = *problem_.cam;
    CamPose pose;
    pose.angle = cam.phase - cam.speed * t;
    const Vec2 arm = cam.eccentricity * unit(pose.angle);
    pose.disc = cam.centre + arm;  // (S23)
    pose.velocity = -cam.speed * perp(arm);
    return pose;
}

void System::place(double t, const double* y) {
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

// So straight that only one foot exists wherever the disc is: |v″| times its distance stays below a half.
bool System::nearly_straight(const double* q) const {
    if (n_ > 1 && shape_bounds_.empty()) return false;
    double curvature = 0;
    for (int i = 0; i + 1 < n_; ++i) curvature += shape_bound(i) * wave_number(i) * wave_number(i) * std::fabs(q[i]);
    const double far =
        model_->length() + std::fabs(problem_.hub.radius) + norm(problem_.cam->centre) + problem_.cam->eccentricity;
    return curvature * far < 0.5;
}

// The foot of the perpendicular from B: a root of r′·(r − B) with r″·(r − B) + r′·r′ > 0          (S24)
Vec2 System::foot(Vec2 disc, bool search, ContactState& c) {
    const double length = model_->length();
    ++gap_evaluations;
    if (search || search_next_) {
        search_next_ = false;
        if (nearly_straight(model_->coordinates() + 1)) {
            x_last_ = std::clamp(dot(disc, unit(model_->coordinates()[0])) - problem_.hub.radius, 0.0, length);
        } else {
            // Nearest of a few points of the beam, then Newton: more points for more curved shapes.
            const int points = problem_.beam.model == ModelKind::exact ? 4 * n_ + 13 : 2 * n_ + 9;
            double best = std::numeric_limits<double>::infinity();
            for (int i = 0; i <= points; ++i) {
                const double x = length * i / points;
                model_->point(x, at_);
                const Vec2 d = at_.r - disc;
                const double distance = dot(d, d);
                if (distance < best) {
                    best = distance;
                    x_last_ = x;
                }
            }
        }
    }
    double x = x_last_, low = 0, high = length;
    c.at_end = false;
    for (int iteration = 0; iteration < 60; ++iteration) {
        model_->point(x, at_);
        const Vec2 d = at_.r - disc;
        const double slope = dot(at_.r1, d);
        if ((x <= 0 && slope >= 0) || (x >= length && slope <= 0)) {
            c.at_end = true;
            break;
        }
        if (slope > 0)
            high = std::min(high, x);
        else
            low = std::max(low, x);
        const double bend = dot(at_.r2, d) + dot(at_.r1, at_.r1);
        double next = bend > 0 ? x - slope / bend : (slope > 0 ? low : high);
        if (next <= low || next >= high) {
            const double edge = next <= low ? low : high;
            const bool free_end = edge == 0 || edge == length;
            next = free_end && bend > 0 ? edge : 0.5 * (low + high);
        }
        const double dx = next - x;
        if (std::fabs(dx) <= 1e-14 * length) break;
        x = next;
    }
    x_last_ = x;
    c.x = x;
    return at_.r - disc;
}

ContactState System::contact(double t, const double* y, bool search) {
    place(t, y);
    return contact_placed(t, y, search);
}

ContactState System::contact_geometry(double t, bool search) {
    ContactState c;
    const CamPose pose = cam(t);
    const Vec2 d = foot(pose.disc, search, c);
    const double distance = norm(d);
    c.normal = d * (1 / distance);
    c.tangent = -perp(c.normal);
    c.gap = distance - problem_.cam->radius - offset_ + phase_.gap_offset;  // (S25)
    c.gap_rate = dot(c.normal, at_.v - pose.velocity);                      // (S26)
    // χ̇ of the tangent; the touching face lies d below the centre line (S27).
    const double turn = cross(at_.r1, at_.v1) / dot(at_.r1, at_.r1);
    const double rim = problem_.cam->speed * problem_.cam->radius;
    c.slip = dot(c.tangent, at_.v - pose.velocity) + offset_ * turn - rim;
    return c;
}

ContactState System::contact_placed(double t, const double* y, bool search) {
    ContactState c = contact_geometry(t, search);
    if (phase_.held) {
        double acc[kMaxSize];
        require_inertia(acc);
        add_torque(t, acc);
        hold(t, c, acc, true);
    } else if (phase_.touching) {
        c.factor = law_.factor(-c.gap_rate, phase_.approach);
        c.force = law_.force(-c.gap, -c.gap_rate, phase_.approach);
        c.friction = friction_force(y, c);
    }
    return c;
}

double System::friction_force(const double* y, ContactState& c) const {
    if (mu_ == 0 && mu_static_ == 0) return 0;
    if (!bristle_) return -mu_ * c.force * std::tanh(c.slip / slip_speed_);  // (S34)
    switch (phase_.grip) {
        case Grip::stick:
            return -(bristle_stiffness_ * y[2 * n_] + bristle_damping_ * c.slip);  // (S35)
        case Grip::slide_plus:
            return -mu_ * c.force;
        case Grip::slide_minus:
            return mu_ * c.force;
    }
    return 0;
}

double System::caught_bristle(const ContactState& c) const {
    return sliding_bristle(c) - bristle_damping_ / bristle_stiffness_ * c.slip;
}

double System::sliding_bristle(const ContactState& c) const {
    const double sign = phase_.grip == Grip::slide_plus ? 1 : -1;
    return sign * mu_ * c.force / bristle_stiffness_;
}

// Sliding, spring and dashpot together carry the kinetic friction: k z + c ż = ±μN (S36).
double System::bristle_rate(const double* y, const ContactState& c) const {
    if (phase_.grip == Grip::stick) return c.slip;
    return bristle_lags() ? bristle_stiffness_ / bristle_damping_ * (sliding_bristle(c) - y[2 * n_]) : 0;
}

double System::foot_speed(const double* y, const ContactState& c) const {
    const double sign = phase_.grip == Grip::slide_plus ? 1 : -1;
    return sign * (c.slip - bristle_rate(y, c));
}

// With the hub's motion prescribed only the beam's own inertia answers, and that is always positive.
bool System::assemble(double* f) { return model_->assemble(f) || drive_.prescribed(); }

void System::require_inertia(double* f) {
    if (!assemble(f)) throw InertiaLost();
}

void System::rhs(double t, const double* y, double* dy) {
    place(t, y);
    double* acc = dy + n_;
    std::fill(dy, dy + size, 0.0);
    double* ledger = dy + controlled;
    if (!assemble(acc)) {
        inertia_lost_ = true;
        std::fill(dy, dy + size, std::numeric_limits<double>::quiet_NaN());
        return;
    }
    inertia_lost_ = false;
    ledger[kLossStructural] = model_->damping_power();
    add_torque(t, acc);
    if (drive_.has_torque()) ledger[kWorkDrive] = drive_.torque(t) * model_->hub_rate();
    ContactState c;
    if (phase_.held) {
        c = contact_geometry(t, false);
        ledger[kWorkDrive] += hold(t, c, acc, true);
    } else if (phase_.touching) {
        c = contact_placed(t, y, false);
        double jn[kMaxSize], jt[kMaxSize];
        contact_rows(c, jn, jt);
        for (int i = 0; i < n_; ++i) acc[i] += c.force * jn[i] + c.friction * jt[i];  // (S28)
        if (bristle_) dy[2 * n_] = bristle_rate(y, c);
    }
    if (!phase_.held) ledger[kWorkDrive] += move(t, acc);
    if (phase_.touching) {
        const CamPose pose = cam(t);
        ledger[kNormalWork] = -c.force * c.gap_rate;
        ledger[kFrictionWork] = -c.friction * c.slip;
        ledger[kWorkCam] = c.force * dot(c.normal, pose.velocity) +
                           c.friction * (dot(c.tangent, pose.velocity) + problem_.cam->speed * problem_.cam->radius);
        ledger[kImpulseN] = c.force;
        ledger[kImpulseT] = c.friction;
    }
    std::copy(y + n_, y + 2 * n_, dy);
    if (drive_.prescribed()) dy[0] = drive_.motion(t).rate;
}

// acc ← M⁻¹ acc, or with the hub moved as prescribed; returns the power of the drive that does it.
double System::move(double t, double* acc) const {
    if (!drive_.prescribed()) {
        model_->solve(acc);
        return 0;
    }
    const HubMotion hub = drive_.motion(t);
    return model_->solve_held(acc, hub.acceleration) * hub.rate;
}

// ξ̈ or Δξ̇ from generalized forces or impulses alone.
void System::respond(double* f) const {
    if (drive_.prescribed())
        model_->solve_held(f, 0);
    else
        model_->solve(f);
}

// Rows of ∂(n·r)/∂ξ, and of ∂(t·r)/∂ξ with the moment of the offset face.
void System::contact_rows(const ContactState& c, double* jn, double* jt) const {
    double jx[kMaxSize], jy[kMaxSize], jchi[kMaxSize];
    model_->jacobian(c.x, jx, jy, jchi);
    for (int i = 0; i < n_; ++i) {
        jn[i] = jx[i] * c.normal.x + jy[i] * c.normal.y;
        jt[i] = jx[i] * c.tangent.x + jy[i] * c.tangent.y + offset_ * jchi[i];
    }
}

// g̈ at ξ̈ = 0 (S44). With w = ṙ − Ḃ, D = r − B and the foot moving by ẋ:
//   ẋ = −(ṙ′·D + r′·w)/(r″·D + r′·r′),   g̈ = ṅ·w + n·(r̈ + ṙ′ẋ − B̈),   ṅ = (Ḋ − n(n·Ḋ))/|D|,   Ḋ = w + r′ẋ
double System::gap_acceleration_at_rest(double t, const ContactState& c) const {
    BeamPoint p;
    model_->point(c.x, p);
    const CamPose pose = cam(t);
    const Vec2 d = p.r - pose.disc, w = p.v - pose.velocity;
    const double rate = c.at_end ? 0 : -(dot(p.v1, d) + dot(p.r1, w)) / (dot(p.r2, d) + dot(p.r1, p.r1));
    const Vec2 d_rate = w + rate * p.r1;
    const Vec2 n_rate = (d_rate - dot(c.normal, d_rate) * c.normal) * (1 / norm(d));
    const double speed = problem_.cam->speed;
    const Vec2 disc_acceleration = -speed * speed * (pose.disc - problem_.cam->centre);
    return dot(n_rate, w) + dot(c.normal, model_->convective(c.x) + rate * p.v1 - disc_acceleration);
}

// Sustained contact: the normal force λ that keeps g = ġ = 0, friction −μλ tanh(v_t/v_s) with it (S45).
// acc: assembled forces in, ξ̈ out. Returns the drive's power.
double System::hold(double t, ContactState& c, double* acc, bool pushed) {
    double jn[kMaxSize], jt[kMaxSize], push[kMaxSize], forces[kMaxSize];
    contact_rows(c, jn, jt);
    const double ratio = -mu_ * std::tanh(c.slip / slip_speed_);
    for (int i = 0; i < n_; ++i) push[i] = jn[i] + ratio * jt[i];
    std::copy_n(acc, n_, forces);
    std::copy_n(push, n_, answer_);
    double free[kMaxSize];
    std::copy_n(acc, n_, free);
    move(t, free);
    respond(answer_);
    double gap_acceleration = gap_acceleration_at_rest(t, c), per_newton = 0;
    for (int i = 0; i < n_; ++i) {
        gap_acceleration += jn[i] * free[i];
        per_newton += jn[i] * answer_[i];
    }
    // Rounding of g and ġ decays at the rate `settle_` (Baumgarte 1972).
    const double wanted = -2 * settle_ * c.gap_rate - settle_ * settle_ * c.gap;
    c.force = pushed ? (wanted - gap_acceleration) / per_newton : 0;
    c.friction = ratio * c.force;
    free_gap_acceleration_ = gap_acceleration;
    for (int i = 0; i < n_; ++i) acc[i] = forces[i] + c.force * push[i];
    return move(t, acc);
}

double System::free_gap_acceleration(double t, const double* y) {
    double acc[kMaxSize];
    place(t, y);
    require_inertia(acc);
    add_torque(t, acc);
    ContactState c = contact_geometry(t, true);
    hold(t, c, acc, false);
    return free_gap_acceleration_;
}

Compliance System::compliance(double t, const double* y, const ContactState& c) {
    double f[kMaxSize], jn[kMaxSize], jt[kMaxSize], by_n[kMaxSize], by_t[kMaxSize];
    place(t, y);
    require_inertia(f);
    contact_rows(c, jn, jt);
    std::copy_n(jn, n_, by_n);
    std::copy_n(jt, n_, by_t);
    respond(by_n);
    respond(by_t);
    Compliance out{0, 0, 0};
    for (int i = 0; i < n_; ++i) {
        out.nn += jn[i] * by_n[i];
        out.nt += 0.5 * (jt[i] * by_n[i] + jn[i] * by_t[i]);
        out.tt += jt[i] * by_t[i];
    }
    return out;
}

// δ_max/v with δ_max = [(n+1)v²/(2 a_nn K)]^{1/(n+1)} of an impact against the mass 1/a_nn.
double System::touch_time(double t, const double* y, const ContactState& c, double approach) {
    const double n = law_.exponent, answer = compliance(t, y, c).nn;
    if (!(approach > 0) || !(answer > 0)) return std::numeric_limits<double>::infinity();
    return std::pow(0.5 * (n + 1) * approach * approach / (answer * law_.stiffness), 1 / (n + 1)) / approach;
}

void System::strike(double t, double* y, const ContactState& c, const ImpactResult& impact) {
    double f[kMaxSize], jn[kMaxSize], jt[kMaxSize], jump[kMaxSize];
    place(t, y);
    require_inertia(f);
    contact_rows(c, jn, jt);
    for (int i = 0; i < n_; ++i) jump[i] = impact.impulse_n * jn[i] + impact.impulse_t * jt[i];
    double* ledger = y + controlled;
    if (drive_.prescribed())
        ledger[kWorkDrive] += model_->solve_held(jump, 0) * drive_.motion(t).rate;
    else
        model_->solve(jump);
    for (int i = 0; i < n_; ++i) y[n_ + i] += jump[i];
    // Work of an impulse: impulse times the mean of the speeds before and after (S46).
    const CamPose pose = cam(t);
    ledger[kNormalWork] -= impact.impulse_n * 0.5 * (c.gap_rate + impact.v_n);
    ledger[kFrictionWork] -= impact.impulse_t * 0.5 * (c.slip + impact.v_t);
    ledger[kWorkCam] += impact.impulse_n * dot(c.normal, pose.velocity) +
                        impact.impulse_t * (dot(c.tangent, pose.velocity) + problem_.cam->speed * problem_.cam->radius);
    ledger[kImpulseN] += impact.impulse_n;
    ledger[kImpulseT] += impact.impulse_t;
}

void System::add_torque(double t, double* f) const {
    if (!drive_.has_torque()) return;
    const double torque = drive_.torque(t);
    for (int i = 0; i < n_; ++i) f[i] += torque * model_->hub_row()[i];
}

bool System::generalized_force(double t, const ContactState& c, double normal, double* f) {
    double jn[kMaxSize], jt[kMaxSize];
    const bool inert = assemble(f);
    add_torque(t, f);
    contact_rows(c, jn, jt);
    const double ratio = bristle_ ? 0 : -mu_ * std::tanh(c.slip / slip_speed_);
    for (int i = 0; i < n_; ++i) f[i] += normal * (jn[i] + ratio * jt[i]);
    return inert;
}

void System::acceleration(double t, const double* y, double* acc) {
    double dy[2 * kMaxSize + 1 + kLedgerSize];
    rhs(t, y, dy);
    std::copy_n(dy + n_, n_, acc);
}

System::Books System::open_books(double t, const double* y) {
    place(t, y);
    const double* ledger = y + controlled;
    Books b;
    b.energies = model_->energies();
    b.loss_structural = ledger[kLossStructural];
    b.loss_contact = ledger[kNormalWork];
    b.loss_friction = ledger[kFrictionWork];
    b.work_cam = ledger[kWorkCam];
    b.work_drive = ledger[kWorkDrive];
    return b;
}

System::Books System::books(double t, const double* y, double gap) {
    Books b = open_books(t, y);
    b.contact = law_.stored_energy(-gap);
    b.loss_contact -= b.contact;
    return b;
}

System::Books System::books(double t, const double* y) {
    Books b = open_books(t, y);
    double normal = 0, bristle = 0;
    if (phase_.touching) {
        const ContactState c = contact_placed(t, y, false);
        normal = phase_.held ? 0 : law_.stored_energy(-c.gap);
        if (bristle_) {
            const double z = phase_.grip == Grip::stick || bristle_lags() ? y[2 * n_] : sliding_bristle(c);
            bristle = 0.5 * bristle_stiffness_ * z * z;
        }
    }
    // What went into the contact is stored or lost (S38).
    b.contact = normal + bristle;
    b.loss_contact -= normal;
    b.loss_friction -= bristle;
    return b;
}

double System::gap_lower_bound(double t, const double* y) const {
    const double nothing[kMaxSize] = {};
    return gap_lower_bound(t, 0, y, nothing);
}

// Distance of B from the straight beam at the frame's angle, less what bending, turning and the cam can add.
double System::gap_lower_bound(double t, double h, const double* xi, const double* spread) const {
    double angle = xi[0], turn = spread[0];
    if (drive_.prescribed()) {
        angle = drive_.motion(t).angle;
        turn = 0;
        for (const double side : {-h, h}) {
            // Within a step all laws turn at a rate that is quadratic in time, or monotone.
            const HubMotion now = drive_.motion(t), then = drive_.motion(t + side);
            turn = std::max({turn, std::fabs(h * now.rate), std::fabs(h * then.rate),
                             std::fabs(h * (now.rate + 0.5 * side * now.acceleration))});
        }
    }
    const Vec2 along = unit(angle);
    const double length = model_->length(), a = problem_.hub.radius;
    const Cam& cam = *problem_.cam;
    const Vec2 disc = this->cam(t).disc;
    const double foot = std::clamp(dot(disc, along), a, a + length);
    return norm(disc - foot * along) - cam.radius - offset_ - deflection_bound(xi, spread) -
           turn * (std::fabs(a) + length) - h * std::fabs(cam.speed) * cam.eccentricity;
}

// How far a point of the beam is from where it would be if the beam were straight. Shortening: |u| <= ½∫v′² and ½|a|α²,
// with α the slope at the root. `exact`: a section turned by ψ − θ moves the points beyond it by at most L|ψ − θ|, and
// |ψ − θ| <= 2Σ|q|.
double System::deflection_bound(const double* xi, const double* spread) const {
    const double length = model_->length(), a = std::fabs(problem_.hub.radius);
    double deflection = 0, slope = 0;
    for (int i = 0; i + 1 < n_; ++i) {
        const double q = std::fabs(xi[i + 1]) + spread[i + 1];
        if (shape_bounds_.empty()) {
            deflection += 2 * length * q;
        } else {
            deflection += shape_bound(i) * q;
            slope += shape_bound(i) * wave_number(i) * q;
        }
    }
    return deflection + 0.5 * (length + a) * slope * slope;
}

double System::travel_bound(const double* change) const {
    const double nothing[kMaxSize] = {};
    return std::fabs(change[0]) * (std::fabs(problem_.hub.radius) + model_->length()) +
           deflection_bound(nothing, change);
}

}  // namespace beamcam::sim
