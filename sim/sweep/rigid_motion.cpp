#include "sim/sweep/rigid_motion.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/numerics.hpp"
#include "sim/contact/chatter.hpp"
#include "sim/run/advancement.hpp"

namespace beamcam::sim {

constexpr double kShortestAdvance = 1e-15;  // [s]
constexpr double kRigidAccuracy = 1e-13;    // [rad] error of a settled motion: some hundred rounding errors
constexpr long kPlacesPerReport = 16384;    // comparisons with the surface between two calls of `progress`

SampledMotion RigidMotion::follow(const Progress& progress) {
    progress_ = &progress;
    while (turn_ < span_.to && !sampler_.done()) {
        report();
        in_contact_ ? stay_in_contact() : fly();
    }
    SampledMotion motion = sampler_.take();
    motion.accuracy = kRigidAccuracy;
    return motion;
}

void RigidMotion::report() {
    if (++places_ % kPlacesPerReport == 0 && *progress_ && !(*progress_)(static_cast<double>(turn_) * period_))
        throw Interrupted();
}

// One Taylor series, or its part up to a touch.
void RigidMotion::fly() {
    series_.expand(state_);
    const double rest = end() - s_, h = std::min(series_.length(), rest);
    const std::optional<double> touch = first_touch(h);
    const double dt = touch.value_or(h);
    const double until = !touch && h == rest ? end() : s_ + dt;
    show_until(until);
    state_ = series_.at(dt);
    touched_ = false;
    move_to(until);
    if (touch) impact();
}

SurfaceAngle RigidMotion::surface_at(double s) {
    if (s != cached_at_) {
        cached_at_ = s;
        cached_ = surface_.at(s);
    }
    return cached_;
}

// By advancement as in (S56), on the angle above the surface G = θ − θ_c: G̈ lies between −(max θ̈_c + |k| − α) and
// |k| + α − min θ̈_c.                                                                                       (S84)
std::optional<double> RigidMotion::first_touch(double h) {
    const Advancement above{std::fabs(mirrored_.k) - mirrored_.alpha + surface_.highest_acceleration(),
                            std::fabs(mirrored_.k) + mirrored_.alpha - surface_.lowest_acceleration()};
    double t = std::max(0.0, clear_until_ - s_);
    const auto gap = [&](double at) {
        const SurfaceAngle c = surface_at(s_ + at);
        return GapAt{series_.theta(at) - c.angle, series_.rate(at) - surface_.rate(c)};
    };
    while (t < h) {
        report();
        auto [g, v] = gap(t);
        if ((touched_ && t == 0) || (g < 0 && v > 0 && g > -kLongRounding)) g = std::max(g, 0.0);
        if (g < 0 || (g == 0 && !(v > 0))) return t;
        if (const auto certain = above.certain_time(g, v))
            return falling_zero(gap, t, {g, v}, t + *certain, h, kAngleRounding);
        // The speed of a gap that opens may be rounding: it is followed until it might close by that of its angles.
        t += std::max(above.clear_time(g, v), g == 0 ? above.clear_time(kAngleRounding, 0) : kShortestAdvance);
    }
    return {};
}

void RigidMotion::impact() {
    const SurfaceAngle c = surface_at(s_);
    const double w = state_.rate - surface_.rate(c), approach = -c.lever * w;
    const Bounce bounce{approach, problem_.contact.restitution * approach};
    const double pull = c.lever * surface_.push(c);
    state_.theta = c.angle;
    touched_ = true;
    if (!(approach > 0)) {  // the beam reaches the surface without approach speed
        if (pull > 0) return rest_on(c);
        return lift_after_impact();
    }
    announce(&Observer::touch, c, state_.rate);
    if (sums_up_chatter(c, bounce)) {
        announce(&Observer::release, c, surface_.rate(c) + bounce.rebound / c.lever);
        return rest_on(c);
    }
    const bool slow = bounce.ends_chatter(pull, last_rebound_, problem_);
    last_rebound_ = bounce.rebound;
    const double kept = slow ? 0 : problem_.contact.restitution, after = surface_.rate(c) - kept * w;
    if (slow && pull > 0) return rest_on(c);
    announce(&Observer::release, c, after);
    state_.rate = after;
    slow ? lift_after_impact() : resume(false);
}

// The conditions of Transitions::sum_up_chatter (S57).
bool RigidMotion::sums_up_chatter(const SurfaceAngle& c, const Bounce& bounce) const {
    if (!bounce.is_summable(problem_.contact)) return false;
    const double pull = c.lever * surface_.push(c), lasts = bounce.chatter_time(pull);
    const double turns = std::fabs(surface_.rate(c)) + std::fabs(problem_.cam->speed);
    if (!(pull > 0 && lasts * turns < kBriefChatter)) return false;
    const SurfaceAngle last = surface_.at(s_ + lasts);
    return is_steady(pull, last.lever * surface_.push(last));
}

void RigidMotion::rest_on(const SurfaceAngle& c) {
    state_ = {c.angle, surface_.rate(c)};
    resume(true);
}

// Sustained contact until the cam falls away faster than the beam.
void RigidMotion::stay_in_contact() {
    if (surface_.always_pulls()) return lift(s_ + 0.5 * period_);
    double from = end(), to = from;
    for (const CamSurface::Lift& lift : surface_.lifts())
        for (const double turn : {-period_, 0.0, period_}) {
            if (!(lift.to + turn > s_) || !(std::max(lift.from + turn, s_) < from)) continue;
            from = std::max(lift.from + turn, s_);
            to = lift.to + turn;
        }
    show_until(from);
    const SurfaceAngle c = surface_.at(from);
    state_ = {c.angle, surface_.rate(c)};
    const bool ends = from == end();
    const double stays = to - from;
    move_to(from);
    if (ends) return;
    announce(&Observer::release, c, state_.rate);
    lift(s_ + stays);
}

// Flight begins on the surface. No touch is possible in the first half of the interval with f < 0.
void RigidMotion::lift(double until) {
    const double pendulum_time = 1 / std::sqrt(std::fabs(mirrored_.k) + std::fabs(mirrored_.alpha) + 1e-300);
    resume(false);
    touched_ = true;
    clear_until_ = s_ + std::min(0.5 * (until - s_), 0.5 * pendulum_time);
}

// Lift from an impact without a rebound.
void RigidMotion::lift_after_impact() {
    if (surface_.always_pulls()) return lift(s_ + 0.5 * period_);
    for (const CamSurface::Lift& window : surface_.lifts())
        for (const double turn : {-period_, 0.0, period_})
            if (window.from + turn <= s_ && s_ < window.to + turn) return lift(window.to + turn);
    rest_on(surface_.at(s_));  // at the edge of an interval, by rounding
}

void RigidMotion::move_to(double s) {
    s_ = s;
    while (s_ >= period_) {
        s_ -= period_;
        clear_until_ -= period_;
        ++turn_;
    }
}

void RigidMotion::put(const RodState& state, double* y) const {
    std::fill_n(y, y_.size(), 0.0);
    y[0] = mirrored_.side * state.theta;
    y[1] = mirrored_.side * state.rate;
}

void RigidMotion::value(double t, double* y) const {
    const double s = t - time(0);
    if (!in_contact_) return put(series_.at(s - s_), y);
    const SurfaceAngle c = surface_.at(s);
    put({c.angle, surface_.rate(c)}, y);
}

void RigidMotion::show_until(double s) {
    t0 = time(s_);
    t1 = time(s);
    sampler_.step({this, t0, t1, false});
}

void RigidMotion::resume(bool in_contact) {
    in_contact_ = in_contact;
    Phase phase;
    phase.touching = phase.held = in_contact;
    put(state_, y_.data());
    sampler_.resume(time(s_), y_, phase);
}

// The beam at the surface with this rate of the hub. v_t: (S27).
void RigidMotion::announce(decltype(&Observer::touch) event, const SurfaceAngle& c, double rate) {
    const Cam& cam = mirrored_.cam;
    const Vec2 arm = cam.eccentricity * unit(cam.phase - cam.speed * s_), velocity = -cam.speed * perp(arm);
    const double along = -dot(unit(c.angle), velocity) - cam.speed * cam.radius;
    ContactState contact;
    contact.x = c.lever - problem_.hub.radius;
    contact.gap_rate = c.lever * (rate - surface_.rate(c));
    contact.slip = mirrored_.side * (along + contact_offset(problem_) * rate);
    put({c.angle, rate}, y_.data());
    (sampler_.*event)(time(s_), y_, contact);
}

}  // namespace beamcam::sim
