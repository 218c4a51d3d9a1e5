#include "sim/run/contact_guards.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/base/numerics.hpp"
#include "sim/cam/motion_law.hpp"
#include "sim/contact/chatter.hpp"
#include "sim/dynamics/failure.hpp"
#include "sim/integrate/step_errors.hpp"

namespace beamcam::sim {
namespace {

constexpr double kForceDifference = 1e-4;  // of the step: finite difference for Ṅ, where the force is smooth
constexpr double kGuardDifference = 1e-2;  // of the step: finite difference for the rate of a guard

// Instants at equal intervals in a segment.
struct Instants {
    double t0, t1;
    int count;
    double operator()(int i) const { return i == count ? t1 : t0 + (t1 - t0) * i / count; }
};

// The first instant at which a guard falls below zero between two of its samples f[0…last] that are positive. The
// search uses finite differences for the rate, and is skipped where the samples exceed their own largest second
// difference.
template <class Value>
std::optional<double> first_dip_of_samples(Value&& value, const Instants& time, const double* f, int last) {
    const double step = kGuardDifference * (time.t1 - time.t0);
    const auto guard = [&](double t) {
        const double early = std::max(time.t0, t - step), late = std::min(time.t1, t + step);
        return Guard{t, value(t), (value(late) - value(early)) / (late - early)};
    };
    double bend = 0;
    for (int i = 1; i < last; ++i) bend = std::max(bend, std::fabs(f[i - 1] - 2 * f[i] + f[i + 1]));
    const double deep = kNegligible * std::fabs(*std::max_element(f, f + last + 1));
    for (int i = 1; i <= last; ++i) {
        if (!(f[i - 1] > 0) || f[i] < 0 || (last > 1 && std::min(f[i - 1], f[i]) > bend)) continue;
        if (!(time(i - 1) < time(i))) continue;  // a step as short as the rounding of the time
        // The sampled values decide the sign: a second evaluation near zero may round otherwise.
        Guard before = guard(time(i - 1)), after = guard(time(i));
        before.value = f[i - 1];
        after.value = f[i];
        if (const auto at = first_fall(guard, before, after, deep)) return at;
    }
    return std::nullopt;
}

// The force of a collocation step is positive all through it: its values at the ends are, and the polynomial through
// its values at the nodes.
bool presses_throughout(const TouchSamples& touch) {
    Lanes nodes;
    for (int k = 0; k < kNodes; ++k) nodes[k] = touch.force[k + 1];
    const LegendreRange range = legendre_range(nodes);
    return range.mean > range.spread && touch.force[0] > 0 && touch.force[TouchSamples::kCount - 1] > 0;
}

}  // namespace

Event ContactGuards::first_lift(const Segment& segment) {
    if (segment.touch() && presses_throughout(*segment.touch())) return {};
    const int count = std::max(4, probe_.pieces(segment));
    const Instants time{segment.t0, segment.t1, count};
    const auto force = [&](double t) { return probe_.contact(segment, t).force; };
    std::array<double, kMaxPieces + 1> f;
    for (int i = 0; i <= count; ++i) f[static_cast<std::size_t>(i)] = force(time(i));
    // A tensile force below this limit is rounding.
    const double mass = probe_.system.model().mass(), largest = *std::max_element(f.begin(), f.begin() + count + 1);
    const double weight = std::fabs(probe_.system.problem().gravity) * mass;
    const double limit = -kNegligible * (weight + largest) - kRestAcceleration * mass;
    for (int i = 0; i <= count; ++i) f[static_cast<std::size_t>(i)] -= limit;
    const auto lifted = [&](double t) { return force(t) - limit; };
    if (f[0] < 0) return {EventKind::lift, segment.t0};
    const int last =
        static_cast<int>(std::find_if(f.begin() + 1, f.begin() + count, [](double v) { return v < 0; }) - f.begin());
    if (const auto at = first_dip_of_samples(lifted, time, f.data(), last)) return {EventKind::lift, *at};
    if (f[static_cast<std::size_t>(last)] < 0)
        return {EventKind::lift, find_root(lifted, time(last - 1), time(last), f[static_cast<std::size_t>(last) - 1],
                                           f[static_cast<std::size_t>(last)])};
    return {};
}

ContactGuards::Guards ContactGuards::evaluate(const Segment& segment, double t) {
    const ContactState c = probe_.contact(segment, t);
    Guards w{c.side, {t, -c.gap, -c.gap_rate}, c.factor, 1};
    const FrictionLaw& friction = probe_.system.friction();
    if (!friction.bristle) return w;
    const FrictionState state = state_.phase.friction;
    const double growth = state == FrictionState::stick ? 0 : force_growth(segment, t);
    w.friction = friction.margin(state, c.force, growth, c.slip, probe_.system.bristle(probe_.state()));
    return w;
}

void ContactGuards::check_side(const Guards& now) {
    if (now.side * state_.side < 0 && now.release.value > 0)
        throw RunStopped(Stop::passed_cam, "the beam passed through the cam");
    if (now.side != 0) state_.side = now.side;
}

// Ṅ [N/s].
double ContactGuards::force_growth(const Segment& segment, double t) {
    const double step = kForceDifference * (segment.t1 - segment.t0);
    const double early = std::max(segment.t0, t - step), late = std::min(segment.t1, t + step);
    return (probe_.contact(segment, late).force - probe_.contact(segment, early).force) / (late - early);
}

Event ContactGuards::first_event(const Segment& segment) {
    if (const TouchSamples* samples = segment.touch()) {
        if (samples->friction_over && may_change_friction()) return {EventKind::friction, segment.t0};
        switch (samples->ending) {
            case TouchSamples::Ending::open:
                return {};
            case TouchSamples::Ending::release:
                return {EventKind::release, segment.t1};
            case TouchSamples::Ending::clamp:
                return {EventKind::clamp, segment.t1};
            case TouchSamples::Ending::friction:
                return {EventKind::friction, segment.t1};
        }
    }
    const int count = std::max(probe_.pieces(segment), probe_.pieces_by_travel(segment, probe_.range(segment)));
    const Instants time{segment.t0, segment.t1, count};
    const auto release = [&](double t) { return evaluate(segment, t).release; };
    const auto friction_at = [&](double t) { return evaluate(segment, t).friction; };
    Event best;
    const auto offer = [&](EventKind kind, std::optional<double> t) {
        if (t && (best.kind == EventKind::none || *t < best.t)) best = {kind, *t};
    };
    Guards a = evaluate(segment, segment.t0);
    check_side(a);
    friction_.assign(static_cast<std::size_t>(count) + 1, a.friction);
    if (segment.t0 == state_.phase_start) a.release.value = std::max(a.release.value, 0.0);
    int last = 0;
    while (last < time.count && best.kind == EventKind::none) {
        const Guards b = evaluate(segment, time(++last));
        check_side(b);
        friction_[static_cast<std::size_t>(last)] = b.friction;
        offer(EventKind::release, first_fall(release, a.release, b.release, probe_.gap_rounding()));
        offer(EventKind::clamp, clamp_event(segment, a, b));
        if (b.friction < 0 && may_change_friction())
            offer(EventKind::friction, a.friction > 0
                                           ? find_root(friction_at, a.release.t, b.release.t, a.friction, b.friction)
                                           : a.release.t);
        a = b;
    }
    if (!probe_.system.has_bristle()) return best;
    const auto at = first_dip_of_samples(friction_at, time, friction_.data(), last);
    if (at && (best.kind == EventKind::none || *at < best.t) && may_change_friction())
        return {EventKind::friction, *at};
    return best;
}

// The normal's angle α in the cam's frame moves by less than half a turn in a step of contact. A step that begins on a
// kink has passed it.                                                                                     (S110)
std::optional<double> ContactGuards::first_kink(const Segment& segment) {
    const TurningCam& cam = probe_.system.cam();
    if (cam.shape().kinks().empty()) return std::nullopt;
    const auto alpha = [&](double t) { return cam.alpha(t, probe_.gap(segment, t).normal); };
    const double from = alpha(segment.t0), turned = std::remainder(alpha(segment.t1) - from, kFullTurn);
    double nearest = std::fabs(turned), kink = 0;
    for (const double k : cam.shape().kinks()) {
        const double ahead = std::copysign(1.0, turned) * std::remainder(k - from, kFullTurn);
        if (!(ahead > kNegligible && ahead < nearest)) continue;
        nearest = ahead;
        kink = k;
    }
    if (nearest == std::fabs(turned)) return std::nullopt;
    const auto beyond = [&](double t) { return std::remainder(alpha(t) - kink, kFullTurn); };
    const double before = beyond(segment.t0), after = beyond(segment.t1);
    return before * after < 0 ? find_root(beyond, segment.t0, segment.t1, before, after) : segment.t1;
}

// False after too many changes at one instant: the friction state then lasts for this step.
bool ContactGuards::may_change_friction() {
    if (state_.idle_events <= kMaxInstantEvents) return true;
    ++state_.statistics.fallbacks.friction_changes;
    return false;
}

// The instant at which the clamp of the force starts or ends.
std::optional<double> ContactGuards::clamp_event(const Segment& segment, const Guards& a, const Guards& b) {
    const NormalLaw& law = probe_.system.normal_law();
    if (!(law.damping > 0)) return std::nullopt;
    const double t0 = a.release.t, t1 = b.release.t, level = -state_.phase.approach / law.damping;
    const bool known = std::fabs(a.clamp) > kNegligible;
    if (known) state_.clamp_side = a.clamp > 0 ? 1 : -1;
    const auto penetration = [&](double t) { return evaluate(segment, t).release; };
    std::optional<double> at;
    for (int tries = 0; tries < 2; ++tries, state_.clamp_side = -state_.clamp_side) {
        at = first_passing(penetration, a.release, b.release, level, state_.clamp_side, -kNegligible * level,
                           kRounding * probe_.system.model().length());
        // Otherwise the step starts on the kink, and the assumed side of it was wrong.
        if (known || !at || *at - t0 > kOnKink * (t1 - t0)) break;
    }
    const bool shows = known && std::fabs(b.clamp) > kNegligible && (a.clamp > 0) != (b.clamp > 0);
    if (shows) {
        const double seen = find_root([&](double t) { return evaluate(segment, t).clamp; }, t0, t1, a.clamp, b.clamp);
        if (!at || !(*at < seen - kNegligible * (t1 - t0))) at = seen;
    }
    return at;
}

}  // namespace beamcam::sim
