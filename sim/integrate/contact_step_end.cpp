#include "sim/integrate/contact_step_end.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/numerics.hpp"

namespace beamcam::sim {

constexpr int kMostCuts = 8;                                 // of a step, to end it at an event
constexpr double kCarriedKick = 0.1;                         // of the tolerance, that the force in between may change
constexpr double kLeastLength = 1e-14, kLeastShift = 1e-16;  // [s] below the rounding of any time in a run
constexpr double kResolvedTurn = 2;  // [rad] of a mode between two instants, which their cubic resolves (S58)

double ContactStepEnd::cut(double error, Ending& ending) {
    // A step far beyond the release only shows how long the next one is. The shorter one may have an event that this
    // one does not show.
    for (int cuts = 0; cuts == 0 || error <= 1; ++cuts) {
        Ending found = Ending::open;
        const double end = first_event(ending, found);
        if (found == Ending::open) break;
        if (cuts == kMostCuts) return kNoSolution;
        ending = found;
        carry = 0;
        error = solve_to(end, ending);
    }
    return error;
}

// When the first event falls in the step just solved, and which.
double ContactStepEnd::first_event(Ending ending, Ending& found) {
    const double first = first_force_event(ending, found);
    if (!friction_.bristle) return first;
    const double slips = FrictionMargin(step_, contact_).end(found == Ending::open, ending == Ending::friction);
    if (!(slips < first)) return first;
    found = Ending::friction;
    return slips;
}

// An event of the normal force: the gap opens, or the clamp begins or ends.                                     (S58)
double ContactStepEnd::first_force_event(Ending ending, Ending& found) {
    const Collocation& gauss = Collocation::get();
    const ContactKinematics<Lanes>& nodes = contact_.load.contact;
    const double h = step_.segment.h, deep = kRounding * step_.form->length;
    const bool clamps = law_.damping > 0;
    const double level = clamps ? -contact_.approach / law_.damping : 0, none = kNegligible * -level;
    ripples_from_ = step_.n;
    const auto probe = [&](double t) { return penetration_at(t); };
    const auto ripple = [&](double span) { return unresolved(span); };
    Guard a{0, std::max(0.0, -contact_.start.gap), -contact_.start.gap_rate};
    start_side_ = std::fabs(a.rate - level) > none ? std::copysign(1.0, a.rate - level) : side_;
    for (int k = 0; k <= kNodes; ++k) {
        Guard b = k < kNodes ? Guard{h * gauss.c[k], -nodes.gap[k], -nodes.gap_rate[k]}
                             : Guard{h, -contact_.end.gap, -contact_.end.gap_rate};
        if (k == kNodes && (ending == Ending::release || ending == Ending::clamp)) b.value = std::max(b.value, 0.0);
        Guard c = b;
        if (k == kNodes && ending == Ending::clamp) c.rate = level;
        double first = kNoSolution;
        const event_search::Quartic between(a, c, ripple(c.t - a.t));
        if (!between.positive(deep)) {
            const auto at = first_fall(probe, a, b, deep, ripple);
            if (at && *at > 0 && *at < h) {
                first = *at;
                found = Ending::release;
            }
        }
        if (clamps && !between.keeps_side(level, start_side_, none)) {
            auto at = first_passing(probe, a, c, level, start_side_, none, deep, ripple);
            // It starts on the kink, and the assumed side was wrong.
            if (at && std::fabs(a.rate - level) <= none && *at - a.t <= kOnKink * (c.t - a.t)) {
                start_side_ = -start_side_;
                at = first_passing(probe, a, c, level, start_side_, none, deep, ripple);
            }
            if (at && *at > 0 && *at < std::min(first, h)) {
                first = *at;
                found = Ending::clamp;
            }
        }
        if (std::isfinite(first)) return first;
        a = b;
    }
    return h;
}

// Penetration and its rate inside the step just solved.
Guard ContactStepEnd::penetration_at(double after) {
    const ExponentialSegment& s = step_.segment;
    scratch_.resize(s.end.size());
    s.motion_inside(s.t0 + after, scratch_.data());
    ContactKinematics<double> touch;
    touch.dx = contact_.end.dx;
    contact_.evaluate(s.t0 + after, scratch_.data(), touch);
    ++step_.system.gap_evaluations;
    return {after, -touch.gap, -touch.gap_rate};
}

// The vibration of the penetration that turns by more than two radians in `span`: the free vibration of a mode, about
// the deflection by its forcing, keeps its amplitude.
Ripple ContactStepEnd::unresolved(double span) {
    Ripple ripple;
    const ExponentialSegment& s = step_.segment;
    for (std::size_t i = step_.n; i-- > 0 && step_.form->oscillators[i].omega * span > kResolvedTurn;) {
        const double w = step_.form->oscillators[i].omega, inverse = 1 / (w * w);
        if (ripples_from_ > i) {
            const Lanes free = s.q[i] - inverse * s.f[i];
            ripples_[i] =
                2 * std::fabs(contact_.row[i]) * std::sqrt(largest(free * free + inverse * (s.v[i] * s.v[i])));
            ripples_from_ = i;
        }
        ripple.value += ripples_[i];
        ripple.rate += w * ripples_[i];
    }
    return ripple;
}

// Solves again, ended at the event, until the end lies on it. The error, as of ContactStep::solve.
double ContactStepEnd::solve_to(double end, Ending ending) {
    double h = end, error = 0, closest = kNoSolution;
    for (int i = 0; i < kMostCuts; ++i) {
        if (!(h > kLeastLength)) return kNoSolution;
        table_.build(step_.form->oscillators, h);
        error = contact_.solve(table_);
        if (!(error <= 1)) return error;
        const double dt = to_event(h, ending);
        if (!std::isfinite(dt)) return kNoSolution;
        if (std::fabs(dt) < kLongRounding * h + kLeastShift) return error;
        // Far from the event the step shows one that is not there.
        const bool near = std::fabs(dt) < kCarried * h;
        if (std::fabs(dt) >= closest) return ending == Ending::friction || !near ? kNoSolution : error;
        if (ending == Ending::clamp && std::fabs(dt) < kOnKink * h) return error;
        if (ending == Ending::friction && near) {
            carry = dt;
            return error;
        }
        // So near that the force in between has no effect: the state is carried over.
        if (ending == Ending::release && near &&
            law_.at(contact_.end.radius).elastic(std::fabs(contact_.end.gap)) * std::fabs(dt) *
                    contact_.mode_rate_per_impulse <
                kCarriedKick * step_.scale_modes) {
            carry = dt;
            return error;
        }
        closest = std::fabs(dt);
        h += std::clamp(dt, -0.9 * h, 0.5 * h);
    }
    return kNoSolution;
}

// From the end of a step of length h to the event, by its rate.
double ContactStepEnd::to_event(double h, Ending ending) const {
    if (ending == Ending::friction) return FrictionMargin(step_, contact_).to_zero();
    if (ending == Ending::release) return -contact_.end.gap / contact_.end.gap_rate;
    const double now = factor(contact_.end.gap_rate), before = factor(contact_.load.contact.gap_rate[kNodes - 1]);
    return -now * (h * (1 - Collocation::get().c[kNodes - 1])) / (now - before);
}

}  // namespace beamcam::sim
