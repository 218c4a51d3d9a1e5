#include "sim/sweep/rigid_motion.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/numerics.hpp"
#include "sim/contact/chatter.hpp"
#include "sim/run/advancement.hpp"
#include "sim/sweep/sampler.hpp"

namespace beamcam::sim {

constexpr double kOpeningDepth = 1e-13;     // [rad] below the surface while the gap opens: rounding
constexpr double kShortestAdvance = 1e-15;  // [s]
constexpr double kFarFromAway = 1.5;        // [rad] from the cam's axis: a little less than π/2
constexpr long kPlacesPerReport = 16384;    // comparisons with the surface between two calls of `progress`

SampledMotion RigidMotion::follow(const Progress& progress) {
    progress_ = &progress;
    while (turn_ < span_.to && !motion_.over_the_top) {
        report();
        in_contact_ ? stay_in_contact() : fly();
    }
    motion_.end.y = {mirrored_.side * state_.theta, mirrored_.side * state_.rate};
    motion_.end.y.resize(2 + kLedgerSize);
    motion_.end.phase.touching = motion_.end.phase.held = in_contact_;
    return std::move(motion_);
}

void RigidMotion::report() {
    if (++places_ % kPlacesPerReport == 0 && *progress_ && !(*progress_)(static_cast<double>(turn_) * period_))
        throw Interrupted();
}

// One Taylor series, or its part up to a touch.
void RigidMotion::fly() {
    left_ = true;
    series_.expand(state_);
    const double rest = end() - s_, h = std::min(series_.length(), rest);
    const std::optional<double> touch = first_touch(h);
    const double dt = touch.value_or(h);
    const bool ends = !touch && h == rest;
    const double until = ends ? end() : s_ + dt;
    observe(until, [&](double s) { return series_.at(s - s_); });
    motion_.over_the_top = leaves(dt);
    state_ = series_.at(dt);
    touched_ = false;
    move_to(until);
    if (touch) impact();
}

// The beam points away from the cam at an end of the interval, or at a turning point in it.                 (S80)
bool RigidMotion::leaves(double dt) const {
    // θ changes by less than |θ̇|t + (|k| + |α|)t²/2, which usually excludes this.
    const double moves =
        (std::fabs(state_.rate) + 0.5 * (std::fabs(mirrored_.k) + std::fabs(mirrored_.alpha)) * dt) * dt;
    if (std::fabs(state_.theta - centre_direction_) + moves < kFarFromAway) return false;
    return points_away(problem_, 0, dt, [&](double t) {
        return HubAt{mirrored_.side * series_.theta(t), mirrored_.side * series_.rate(t)};
    });
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
        if ((touched_ && t == 0) || (g < 0 && v > 0 && g > -kOpeningDepth)) g = std::max(g, 0.0);
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
    ++motion_.impacts;
    if (sums_up_chatter(c, bounce)) {
        sample_impact(c, surface_.rate(c) + bounce.rebound / c.lever);
        return rest_on(c);
    }
    const bool slow = bounce.ends_chatter(pull, last_rebound_, problem_);
    last_rebound_ = bounce.rebound;
    const double kept = slow ? 0 : problem_.contact.restitution, after = surface_.rate(c) - kept * w;
    if (slow && pull > 0) {
        sample_impact(c, kNan);
        return rest_on(c);
    }
    sample_impact(c, after);
    state_.rate = after;
    if (slow) lift_after_impact();
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
    in_contact_ = true;
    state_ = {c.angle, surface_.rate(c)};
}

// Sustained contact until the cam falls away faster than the beam.
void RigidMotion::stay_in_contact() {
    const auto at = [&](double s) {
        const SurfaceAngle c = surface_.at(s);
        return RodState{c.angle, surface_.rate(c)};
    };
    if (surface_.always_pulls()) return lift(s_ + 0.5 * period_);
    double from = end(), to = from;
    for (const CamSurface::Lift& lift : surface_.lifts())
        for (const double turn : {-period_, 0.0, period_}) {
            if (!(lift.to + turn > s_) || !(std::max(lift.from + turn, s_) < from)) continue;
            from = std::max(lift.from + turn, s_);
            to = lift.to + turn;
        }
    observe(from, at);
    state_ = at(from);
    const bool ends = from == end();
    const double stays = to - from;
    move_to(from);
    if (ends) return;
    end_lasting_sample();
    lift(s_ + stays);
}

// Flight begins on the surface. No touch is possible in the first half of the interval with f < 0.
void RigidMotion::lift(double until) {
    const double pendulum_time = 1 / std::sqrt(std::fabs(mirrored_.k) + std::fabs(mirrored_.alpha) + 1e-300);
    in_contact_ = false;
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

// Samples strobes and sections after s_ and up to `until`; at(s) is the state.
template <class At>
void RigidMotion::observe(double until, At&& at) {
    if (static_cast<double>(turn_) + until / period_ < static_cast<double>(span_.from)) return;
    const auto each = [&](double phase, auto&& visit) {
        for (long k = 0; (static_cast<double>(k) + phase) * period_ <= until; ++k) {
            const double s = (static_cast<double>(k) + phase) * period_;
            const long turn = turn_ + k;
            const bool first = turn == 0 && s == 0 && s_ == 0;  // the initial state
            if ((s > s_ || first) && turn >= span_.from && turn < span_.to) visit(s);
        }
    };
    if (sampling_.kind == SampleKind::section)
        each(section_phase_, [&](double s) { motion_.samples.push_back(sample(s, at(s))); });
    each(kStrobePhase, [&](double s) { strobe(at(s)); });
}

}  // namespace beamcam::sim
