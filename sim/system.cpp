#include "sim/system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/shapes.hpp"

namespace beamcam::sim {

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
        bristle_ = problem.cam.has_value();
        mu_ = grip->coefficient;
        mu_static_ = std::max(mu_, grip->static_coefficient.value_or(mu_));
        // Mindlin's ratio of tangential to normal stiffness, 2(1−ν)/(2−ν), times the normal stiffness
        // n K δⁿ⁻¹ at the penetration that the beam's mass reaches at 1 m/s (S37).
        const double n = law_.exponent, nu = problem.beam.poisson_ratio;
        const double depth = std::pow(0.5 * (n + 1) * model_->mass() / law_.stiffness, 1 / (n + 1));
        bristle_stiffness_ = grip->stiffness.value_or(2 * (1 - nu) / (2 - nu) * n * law_.stiffness * std::pow(depth, n - 1));
        bristle_damping_ = grip->damping.value_or(0);
    }
    controlled = 2 * n_ + (bristle_ ? 1 : 0);
    size = controlled + kLedgerSize;
    for (int i = 0; i + 1 < n_; ++i) highest_frequency_ = std::max(highest_frequency_, model_->frequency(i));
    x_last_ = 0.5 * model_->length();
}

CamPose System::cam(double t) const {
    const Cam& cam = *problem_.cam;
    CamPose pose;
    pose.angle = cam.phase - cam.speed * t;
    const Vec2 arm = cam.eccentricity * unit(pose.angle);
    pose.disc = cam.centre + arm;                     // (S23)
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

// The foot of the perpendicular from B: a root of r′·(r − B) with r″·(r − B) + r′·r′ > 0          (S24)
Vec2 System::foot(Vec2 disc, bool search, ContactState& c) {
    const double length = model_->length();
    ++gap_evaluations;
    if (search || search_next_) {
        search_next_ = false;
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

ContactState System::contact_placed(double t, const double* y, bool search) {
    ContactState c;
    const CamPose pose = cam(t);
    const Vec2 d = foot(pose.disc, search, c);
    const double distance = norm(d);
    c.normal = d * (1 / distance);
    c.tangent = -perp(c.normal);
    c.gap = distance - problem_.cam->radius - offset_ + phase_.gap_offset;                      // (S25)
    c.gap_rate = dot(c.normal, at_.v - pose.velocity);                                          // (S26)
    // χ̇ of the tangent; the touching face lies d below the centre line (S27).
    const double turn = cross(at_.r1, at_.v1) / dot(at_.r1, at_.r1);
    const double rim = problem_.cam->speed * problem_.cam->radius;
    c.slip = dot(c.tangent, at_.v - pose.velocity) + offset_ * turn - rim;
    if (phase_.touching) {
        c.factor = law_.factor(-c.gap_rate, phase_.approach);
        c.force = law_.force(-c.gap, -c.gap_rate, phase_.approach);
        c.friction = friction_force(y, c);
    }
    return c;
}

double System::friction_force(const double* y, ContactState& c) const {
    if (mu_ == 0 && mu_static_ == 0) return 0;
    if (!bristle_) return -mu_ * c.force * std::tanh(c.slip / slip_speed_);                     // (S34)
    switch (phase_.grip) {
        case Grip::stick: return -(bristle_stiffness_ * y[2 * n_] + bristle_damping_ * c.slip); // (S35)
        case Grip::slide_plus: return -mu_ * c.force;
        case Grip::slide_minus: return mu_ * c.force;
    }
    return 0;
}

double System::sliding_bristle(const ContactState& c) const {
    const double sign = phase_.grip == Grip::slide_plus ? 1 : -1;
    return sign * mu_ * c.force / bristle_stiffness_;
}

void System::rhs(double t, const double* y, double* dy) {
    place(t, y);
    double* acc = dy + n_;
    std::fill(dy, dy + size, 0.0);
    double* ledger = dy + controlled;
    if (!model_->assemble(acc)) {
        inertia_lost_ = true;
        std::fill(dy, dy + size, std::numeric_limits<double>::quiet_NaN());
        return;
    }
    inertia_lost_ = false;
    ledger[kLossStructural] = model_->damping_power();
    if (drive_.has_torque()) {
        const double torque = drive_.torque(t);
        for (int i = 0; i < n_; ++i) acc[i] += torque * model_->hub_row()[i];
        ledger[kWorkDrive] = torque * model_->hub_rate();
    }
    if (phase_.touching) {
        ContactState c = contact_placed(t, y, false);
        double jx[kMaxSize], jy[kMaxSize], jchi[kMaxSize];
        model_->jacobian(c.x, jx, jy, jchi);
        const Vec2 force = c.force * c.normal + c.friction * c.tangent;
        const double moment = offset_ * c.friction;
        for (int i = 0; i < n_; ++i) acc[i] += jx[i] * force.x + jy[i] * force.y + moment * jchi[i];    // (S28)
        const CamPose pose = cam(t);
        ledger[kNormalWork] = -c.force * c.gap_rate;
        ledger[kFrictionWork] = -c.friction * c.slip;
        ledger[kWorkCam] = c.force * dot(c.normal, pose.velocity) +
                           c.friction * (dot(c.tangent, pose.velocity) + problem_.cam->speed * problem_.cam->radius);
        ledger[kImpulseN] = c.force;
        ledger[kImpulseT] = c.friction;
        if (bristle_) dy[2 * n_] = phase_.grip == Grip::stick ? c.slip : 0;
    }
    if (drive_.prescribed()) {
        const HubMotion hub = drive_.motion(t);
        const double torque = model_->solve_held(acc, hub.acceleration);
        ledger[kWorkDrive] = torque * hub.rate;
        dy[0] = hub.rate;
        std::copy(y + n_ + 1, y + 2 * n_, dy + 1);
    } else {
        model_->solve(acc);
        std::copy(y + n_, y + 2 * n_, dy);
    }
}

void System::acceleration(double t, const double* y, double* acc) {
    double dy[2 * kMaxSize + 1 + kLedgerSize];
    rhs(t, y, dy);
    std::copy_n(dy + n_, n_, acc);
}

System::Books System::books(double t, const double* y) {
    place(t, y);
    const double* ledger = y + controlled;
    Books b;
    b.energies = model_->energies();
    b.loss_structural = ledger[kLossStructural];
    b.work_cam = ledger[kWorkCam];
    b.work_drive = ledger[kWorkDrive];
    double normal = 0, bristle = 0;
    if (phase_.touching) {
        const ContactState c = contact_placed(t, y, false);
        normal = law_.stored_energy(-c.gap);
        if (bristle_) {
            const double z = phase_.grip == Grip::stick ? y[2 * n_] : sliding_bristle(c);
            bristle = 0.5 * bristle_stiffness_ * z * z;
        }
    }
    // What went into the contact is stored or lost (S38).
    b.contact = normal + bristle;
    b.loss_contact = ledger[kNormalWork] - normal;
    b.loss_friction = ledger[kFrictionWork] - bristle;
    return b;
}

double System::gap_lower_bound(double t, const double* y) const {
    // Distance of B from the straight beam at the frame's angle, less what bending can add: no shape
    // exceeds 3 in value, and a section turned by ψ − θ moves the points beyond it by at most L|ψ − θ|.
    const Vec2 along = unit(drive_.prescribed() ? drive_.motion(t).angle : y[0]);
    const double length = model_->length(), a = problem_.hub.radius;
    const Vec2 disc = cam(t).disc;
    const double foot = std::clamp(dot(disc, along), a, a + length);
    return norm(disc - foot * along) - problem_.cam->radius - offset_ - bending_reach(y);
}

double System::bending_reach(const double* coordinates) const {
    double sum = 0;
    for (int i = 1; i < n_; ++i) sum += std::fabs(coordinates[i]);
    return sum * (problem_.beam.model == ModelKind::exact ? 2 * model_->length() : 3.0 + 3.0 * std::fabs(problem_.hub.radius) / model_->length());
}

double System::gap_speed_bound(const double* y) const {
    const Cam& cam = *problem_.cam;
    return std::fabs(y[n_]) * (std::fabs(problem_.hub.radius) + model_->length()) + bending_reach(y + n_) +
           std::fabs(cam.speed) * cam.eccentricity;
}

}  // namespace beamcam::sim
