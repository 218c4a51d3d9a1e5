#include "sim/run/transitions.hpp"

#include <algorithm>
#include <cmath>

#include "sim/contact/chatter.hpp"

namespace beamcam::sim {

constexpr double kFirstTouchStep = 0.05;  // of the time to maximum penetration, so that all stages see the force
constexpr double kBounces = 4;            // largest number of bounces within the first step of a flight

void Transitions::start(const InitialContact* continued) {
    if (continued) {
        first_approach_ = continued->first_approach.value_or(continued->approach_speed);
        last_release_ = continued->last_release;
    }
    if (!state_.phase.touching) return;
    if (!continued) return start_friction();
    if (state_.phase.held) return;
    const ContactState c = contact_now();
    state_.clamp_side = c.factor < 0 ? -1 : 1;
    integrator_.limit_first_step(kFirstTouchStep *
                                 system_.touch_time(state_.t, state_.y.data(), c, state_.phase.approach));
}

void Transitions::announce_start() {
    if (state_.phase.touching) announce(&Observer::touch, state_.y, contact_now());
}

void Transitions::apply(const Event& event) {
    switch (event.kind) {
        case EventKind::none:
        case EventKind::kink:  // only ends the step
            break;
        case EventKind::clamp:  // only ends the step, so that the kink lies between two steps
            state_.clamp_side = -state_.clamp_side;
            break;
        case EventKind::touch:
            problem().contact.model == ContactModel::restitution ? impact() : touch();
            break;
        case EventKind::lift:
            lift();
            break;
        case EventKind::release:
            release();
            break;
        case EventKind::friction:
            change_friction();
            break;
    }
}

void Transitions::announce(decltype(&Observer::touch) event, const std::vector<double>& y, const ContactState& c) {
    for (Observer* observer : state_.observers)
        if (!observer->done()) (observer->*event)(state_.t, y, c);
}

void Transitions::touch() {
    cancel_gap_rounding();
    state_.phase.touching = true;
    state_.clamp_side = 1;
    state_.side = 0;
    state_.phase_start = state_.t;
    enter_phase();
    const double approach = -contact_now().gap_rate;
    const ApproachFloor& floor = problem().contact.approach_floor;
    const bool same_collision = last_release_ && state_.t - *last_release_ < collision_gap(problem());
    if (!same_collision) first_approach_ = approach;
    state_.phase.approach =
        std::max(floor.policy == ApproachFloorPolicy::first_touch ? first_approach_ : approach, floor.value);
    if (approach < floor.value) ++state_.statistics.floored;
    start_friction();
    enter_phase();
    const ContactState c = contact_now();
    announce(&Observer::touch, state_.y, c);
    // A first step as long as the impact could move the beam into the cam before any stage evaluates the force.
    integrator_.limit_first_step(kFirstTouchStep *
                                 system_.touch_time(state_.t, state_.y.data(), c, state_.phase.approach));
}

void Transitions::release() {
    const ContactState c = contact_now();
    announce(&Observer::release, state_.y, c);
    begin_flight();
    if (system_.has_bristle()) bristle() = 0;
}

void Transitions::begin_flight() {
    state_.phase.touching = state_.phase.held = false;
    cancel_gap_rounding();
    state_.phase_start = state_.t;
    last_release_ = state_.t;
}

// State of friction at the touch: slip unless the bristle can stick. For n > 1 the normal force starts with zero slope,
// so any slip breaks the bond at once; for n = 1 both forces grow linearly.
void Transitions::start_friction() {
    state_.phase.friction = FrictionState::stick;
    const FrictionLaw& friction = system_.friction();
    if (!friction.bristle) return;
    bristle() = 0;
    enter_phase();
    const ContactState c = contact_now();
    const double growth =
        contact_exponent(problem()) > 1 ? 0 : system_.normal_law().stiffness * std::max(0.0, -c.gap_rate);
    const bool breaks = friction.stiffness * std::fabs(c.slip) > friction.limit * growth;
    if (breaks && c.slip != 0 && !(c.gap < 0))
        state_.phase.friction = c.slip > 0 ? FrictionState::slide_plus : FrictionState::slide_minus;
    enter_phase();
}

void Transitions::change_friction() {
    const FrictionLaw& friction = system_.friction();
    const ContactState c = contact_now();
    // While it slides, the bristle follows its force: it has no state until it sticks again.
    if (state_.phase.friction == FrictionState::stick) {
        state_.phase.friction = c.friction < 0 ? FrictionState::slide_plus : FrictionState::slide_minus;
        bristle() = 0;
    } else {
        bristle() = friction.sliding_bristle(state_.phase.friction, c.force);
        state_.phase.friction = FrictionState::stick;
    }
    enter_phase();
}

// The gap at an event is zero up to rounding. Makes it exactly zero, so that rounding causes no new touch.
void Transitions::cancel_gap_rounding() {
    state_.phase.gap_offset = 0;
    enter_phase();
    const double left = contact_now().gap;
    state_.phase.gap_offset = -left;
    enter_phase();
    state_.statistics.fallbacks.gap = std::max(state_.statistics.fallbacks.gap, std::fabs(left));
}

void Transitions::impact() {
    cancel_gap_rounding();
    const ContactState c = contact_now();
    const double approach = -c.gap_rate;
    const Compliance compliance = system_.compliance(state_.t, state_.y.data(), c);
    const auto resolve = [&](double restitution) {
        return resolve_impact(compliance, c.gap_rate, c.slip, system_.friction().kinetic, restitution,
                              problem().contact.law);
    };
    ImpactResult impact = resolve(problem().contact.restitution);
    if (sum_up_chatter(c, impact, resolve(0))) return;
    // Chatter has also ended when the integrator cannot separate a rebound from the next touch.
    const bool chatter = Bounce{approach, impact.v_n}.ends_chatter(pull_on_cam(), last_rebound_, problem());
    const bool slow = chatter || state_.idle_events > kMaxInstantEvents;
    last_rebound_ = impact.v_n;
    state_.phase_start = state_.t;
    // The gap opens: it was negative only by rounding, and there is no impact.
    if (!slow && !(approach > 0)) return;
    if (!chatter && slow) ++state_.statistics.fallbacks.strikes;
    announce(&Observer::touch, state_.y, c);
    if (slow) impact = resolve(0);
    if (approach > 0) system_.apply_impact(state_.t, state_.y.data(), c, impact);
    const double pull_after = pull_on_cam();
    if (slow && pull_after > -kRestAcceleration) {
        hold();
        ++state_.statistics.chatters;
        return;
    }
    // The error of a step much longer than the bounce exceeds the bounce's height: bounces would never die out.
    if (pull_after > 0) integrator_.limit_first_step(kBounces * 2 * impact.v_n / pull_after);
    record_rebound(state_.y, c, impact);
}

void Transitions::record_rebound(const std::vector<double>& y, ContactState c, const ImpactResult& impact) {
    c.gap_rate = impact.v_n;
    c.slip = impact.v_t;
    announce(&Observer::release, y, c);
    last_release_ = state_.t;
}

// Sustained contact begins.
void Transitions::hold() {
    state_.phase.touching = state_.phase.held = true;
    enter_phase();
}

// Bounces under a constant acceleration a towards the cam, each of which keeps the fraction e of its speed, end after
// T = 2v/(a(1 − e)). A plastic impact with sustained contact afterwards gives the beam the same impulse with the same
// first moment in time, so the run continues with it; the contact counts as sustained after T.      (S57)
// False if the conditions do not hold and the bounces must be integrated.
bool Transitions::sum_up_chatter(const ContactState& c, const ImpactResult& impact, const ImpactResult& plastic) {
    const Bounce bounce{-c.gap_rate, impact.v_n};
    if (!bounce.is_summable(problem().contact)) return false;
    std::vector<double> settled = state_.y;
    system_.apply_impact(state_.t, settled.data(), c, plastic);
    const double pull = -system_.free_gap_acceleration(state_.t, settled.data());
    const double lasts = bounce.chatter_time(pull);
    const double turns = std::fabs(system_.model().hub_rate()) + std::fabs(problem().cam->speed);
    if (!(pull > 0 && lasts * (system_.highest_frequency() + turns) < kBriefChatter)) return false;

    const Phase flight = state_.phase;
    hold();
    std::vector<double> rates(state_.y.size());
    system_.rhs(state_.t, settled.data(), rates.data());
    for (std::size_t i = 0; i < rates.size(); ++i) rates[i] = settled[i] + lasts * rates[i];
    const double later = -system_.free_gap_acceleration(state_.t + lasts, rates.data());
    if (!is_steady(pull, later)) {
        state_.phase = flight;
        enter_phase();
        return false;
    }
    announce(&Observer::touch, state_.y, c);
    std::vector<double> struck = state_.y;
    system_.apply_impact(state_.t, struck.data(), c, impact);
    record_rebound(struck, c, impact);
    state_.y = std::move(settled);
    state_.phase_start = state_.t;
    state_.chatter_end = state_.t + lasts;
    ++state_.statistics.chatters;
    return true;
}

void Transitions::lift() {
    if (!state_.chatter_end) announce(&Observer::release, state_.y, contact_now());
    state_.chatter_end.reset();
    begin_flight();
}

void Transitions::end_chatter() {
    state_.chatter_end.reset();
    ContactState c = contact_now();
    c.gap_rate = 0;  // but for rounding
    announce(&Observer::touch, state_.y, c);
}

}  // namespace beamcam::sim
