#include "sim/run/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/base/numerics.hpp"
#include "sim/dynamics/failure.hpp"
#include "sim/dynamics/initial.hpp"
#include "sim/dynamics/system.hpp"
#include "sim/integrate/event_search.hpp"
#include "sim/integrate/exponential.hpp"
#include "sim/integrate/gap_probe.hpp"
#include "sim/observe/observe.hpp"
#include "sim/observe/trajectory.hpp"
#include "sim/observe/warnings.hpp"
#include "sim/run/horizon.hpp"

namespace beamcam::sim {
namespace {

enum class EventKind { none, touch, release, clamp, grip, lift };

constexpr long kTold = 15;        // steps between two calls of `progress`, less one
constexpr long kLooksTold = 255;  // the same of looks into one step
// Looks into one step for events, at most: where its components are polynomials of degree twelve this resolves them.
constexpr int kMaxLooks = 16;
constexpr double kMostPieces = 1e5;          // of one step, for touches
constexpr long kMostLooks = 100000;          // of the advancement through one step
constexpr long kFirstLooks = 2000;           // of them, until the pace tells whether they will do
constexpr double kNoFactor = 1e-9;           // of the clamp's factor: less is rounding, and has no sign
constexpr double kLeastFootStiffness = 0.5;  // r″·D + r′·r′ where the gap is advanced through by a bound
constexpr double kLongStep = 1e3;            // [rad] of the fastest vibration; such steps are looked into many times
// Grip and slip may both find themselves broken within rounding, and a rebound may be lost in the error of a step: more
// events than this at one instant are not resolved. The grip then stays as it is for a step, the strike is plastic.
constexpr int kMostFlips = 10;
// Whoever will need a hundred times the budget of steps need not spend it first: the pace is that of the later half of
// the steps so far. Fewer than kSurePace may be those of a brief phase, a touch or a transient: their pace counts only
// where it is hopeless by as much more, squared.
constexpr long kFirstPace = 20000;  // chatter may take some thousands
constexpr double kSurePace = 30000, kHopeless = 100;
constexpr double kEndless = 1e60;        // of the length: far beyond any sense, and far from overflow
constexpr double kBounces = 4;           // a first step in flight spans, at most
constexpr double kLowestBounce = 1e-13;  // of the beam's length: the gap is known to about 1e-15 of it
constexpr double kRestSpeed = 1e-12;     // [m/s] slower is rounding
constexpr double kStepErrors = 10;       // of one step in the gap, to which several coordinates contribute
// Chatter is summed up (S57) once what is left of it is so brief, against the fastest vibration and turn, that the
// sum errs by (10⁻³)²/6 of the last rebound, and the pull on the beam stays the same all the while.
constexpr double kBriefChatter = 1e-3, kSteadyPull = 1e-2;
struct Event {
    EventKind kind = EventKind::none;
    double t = 0;
};

class Run {
  public:
    Run(const Problem& problem, std::span<const Request> requests, const Progress& progress, TrajectoryWriter* keep)
        : problem_(problem),
          progress_(progress),
          keep_(keep),
          dynamics_(problem),
          scout_(dynamics_),
          gap_(scout_),
          audience_(dynamics_, requests),
          end_(audience_.end()) {
        const Solver& solver = problem.solver;
        // `auto` keeps a reserve: local errors of a third of the tolerance, so that what adds up over
        // many impacts stays within the ledger's bound of ten times rtol.
        const double share = solver.method == Method::automatic ? 1.0 / 3 : 1;
        integrator_ = make_integrator(solver, share * solver.rtol, share * solver.atol);
        y_.resize(static_cast<std::size_t>(dynamics_.size));
        probe_y_.resize(y_.size());
    }

    // Throws SolverError with what was reached by then.
    std::vector<Result> go() {
        try {
            integrate();
        } catch (const StepFailure& failure) {
            if (dynamic_cast<const InertiaLost*>(&failure)) why_ = Stop::inertia_lost;
            if (!started_)
                throw SolverError(
                    fmt::format("at the start: {}; give another initial.shape or initial.angle", failure.what()), 0,
                    {});
            audience_.give_up(t_, y_, tally_source_);
            throw SolverError(explain(failure), t_, audience_.results());
        }
        if (keep_) keep_->end(end_);
        return audience_.results();
    }
    Counters counters() const { return tally().counters; }

  private:
    std::unique_ptr<Integrator> make_integrator(const Solver& solver, double rtol, double atol) {
        switch (solver.method) {
            case Method::automatic:
            case Method::exponential:
                return make_exponential(dynamics_, rtol, atol);
            case Method::rk8:
                return make_rk8(dynamics_, rtol, atol);
            case Method::cvode_adams:
            case Method::cvode_bdf:
            case Method::arkode_erk:
                break;
        }
        return make_sundials(solver.method, dynamics_, rtol, atol);
    }

    void integrate() {
        const InitialState start = initial_state(dynamics_);
        y_ = start.y;
        t_ = 0;
        unresolved_.left_behind = start.left_behind;
        kinks_ = dynamics_.drive().kinks();
        phase_ = start.phase;
        enter_phase();
        started_ = true;
        audience_.begin(phase_, y_);
        if (keep_) keep_->begin(phase_, y_);
        integrator_->stop_at(next_kink());
        if (phase_.touching) {
            set_grip();
            tell_touch(contact_now());
        }
        go_on();
        long steps = 0;
        while (t_ < end_) {
            keep_to_budget();
            keep_in_bounds();
            const Segment* segment = &integrator_->step();
            last_step_ = segment->t1 - segment->t0;
            if ((++steps & kTold) == 0 || last_step_ * dynamics_.highest_frequency() > kLongStep) tell(segment->t1);
            take(*segment);
        }
    }

    // Goes to the first event in the segment, or to its end.
    void take(const Segment& segment) {
        const Event event = first_event(segment);
        if (event.kind == EventKind::none) {
            const bool kink = segment.t1 >= next_kink();
            pass(segment, segment.t0, kink);
            if (kink) pass_kinks();
            if (kink) go_on();
        } else if (reach(segment, event)) {
            change(event);
            pass_kinks();
            go_on();
        }
    }

    // Tells of the segment from `from`, as far as anybody looks; something happens at its end or not.
    void pass(const Segment& segment, double from, bool event) {
        const double to = std::min(segment.t1, end_);
        const bool happens = event && segment.t1 <= end_;
        const Notes* notes = audience_.stretch(segment, from, to, happens, tally_source_);
        if (keep_) keep_->stretch(segment, from, to, happens, tally(), notes);
        segment.value(to, y_.data());
        t_ = to;
    }

    // From (t_, y_) after an event, and at the start.
    void go_on() {
        audience_.resume(t_, y_, phase_, tally_source_);
        if (keep_) keep_->resume(t_, y_, phase_, tally());
        if (t_ < end_) integrator_->start(t_, y_.data());
    }

    void tell_touch(const ContactState& c) {
        audience_.touch(t_, y_.data(), c);
        if (keep_) keep_->touch(t_, y_, c);
    }
    void tell_release(const std::vector<double>& y, const ContactState& c) {
        audience_.release(t_, y.data(), c);
        if (keep_) keep_->release(t_, y, c);
    }

    void keep_to_budget() {
        const long tried = integrator_->counters.steps + integrator_->counters.rejected;
        if (tried >= problem_.solver.max_steps) {
            why_ = Stop::steps_spent;
            throw StepFailure("the budget of steps is spent");
        }
        if (tried < next_pace_) return;
        const auto lately = static_cast<double>(tried - paced_);
        whole_ = static_cast<double>(tried) + lately * (end_ - t_) / (t_ - paced_time_);
        const double unsure = std::max(1.0, kSurePace / lately);
        next_pace_ = 2 * tried;
        paced_ = tried;
        paced_time_ = t_;
        if (!(whole_ > kHopeless * unsure * unsure * problem_.solver.max_steps)) return;
        why_ = Stop::too_slow;
        throw StepFailure("the budget of steps cannot do");
    }

    // An equation that lets a deflection grow without end would go on until numbers overflow.
    void keep_in_bounds() {
        for (std::size_t i = 1; i < static_cast<std::size_t>(dynamics_.coordinates()); ++i)
            if (!(std::fabs(y_[i]) < kEndless * problem_.beam.length))
                throw StepFailure("the deflection grows without end");
    }

    double next_kink() const {
        const double kink = kinks_.empty() ? std::numeric_limits<double>::infinity() : kinks_.front();
        return std::min(kink, settles_.value_or(kink));
    }

    // An event may fall on a kink, or so near before it that no step fits between.
    bool has_come(double t) const { return t - t_ <= 1e-14 * std::fabs(t_); }
    void pass_kinks() {
        while (!kinks_.empty() && has_come(kinks_.front())) kinks_.erase(kinks_.begin());
        if (settles_ && has_come(*settles_)) {
            settles_.reset();
            ContactState c = contact_now();
            c.gap_rate = 0;  // but for rounding
            tell_touch(c);
        }
        integrator_->stop_at(next_kink());
    }

    void enter_phase() {
        dynamics_.set_phase(phase_);
        scout_.set_phase(phase_);
    }

    void tell(double t) const {
        if (progress_ && !progress_(std::min(t, end_))) throw Interrupted();
    }

    // ---- guards ----

    ContactState contact_at(const Segment& segment, double t, bool search) {
        segment.value(t, probe_y_.data());
        return scout_.contact(t, probe_y_.data(), search);
    }
    // In flight, and no more than gap, rate and foot.
    ContactState gap_at(const Segment& segment, double t, bool search) {
        segment.value(t, probe_y_.data());
        return gap_.look(t, probe_y_.data(), search);
    }
    ContactState contact_now() { return scout_.contact(t_, y_.data(), true); }

    int pieces(const Segment& segment) const {
        return static_cast<int>(
            std::clamp(std::ceil((segment.t1 - segment.t0) * scout_.highest_frequency()), 2.0, double(kMaxLooks)));
    }

    Event first_event(const Segment& segment) {
        if (!problem_.cam) return {};
        if (phase_.held) return lift_in(segment);
        return phase_.touching ? event_in_contact(segment) : touch_in(segment);
    }

    // Every coordinate stays within `spread` of `middle`.
    struct Range {
        std::array<double, kMaxSize> middle, spread;
    };

    Event touch_in(const Segment& segment) {
        if (const MotionBounds* bounds = segment.bounds()) return touch_by_advance(segment, *bounds);
        const Range range = range_in(segment);
        const double half = 0.5 * (segment.t1 - segment.t0);
        if (scout_.gap_lower_bound(segment.t0 + half, half, range.middle.data(), range.spread.data()) > 0) return {};
        return touch_between(segment, segment.t1, std::max(pieces(segment), pieces_by_travel(segment, range)));
    }
    // A long step may carry the beam through the cam and out again: no piece moves it by more than half a radius.
    int pieces_by_travel(const Segment& segment, const Range& range) {
        const Cam& cam = *problem_.cam;
        const double half = 0.5 * (segment.t1 - segment.t0);
        const double travel =
            2 * (scout_.travel_bound(range.spread.data()) + half * std::fabs(cam.speed) * cam.eccentricity);
        return many(travel / (0.5 * cam.radius));
    }
    int many(double pieces) {
        if (pieces > kMostPieces) ++unresolved_.coarse;
        return static_cast<int>(std::clamp(std::ceil(pieces), 2.0, kMostPieces));
    }

    // From the values at points of Chebyshev: a polynomial of that degree leaves the middle of its values there by no
    // more than Lebesgue's constant of the points, <= 1 + (2/π) ln 12, times half of their range.
    Range range_in(const Segment& segment) {
        constexpr int kDegree = Segment::kDegree;
        constexpr double kLebesgue = 2.6, kPi = std::numbers::pi;
        const auto n = static_cast<std::size_t>(dynamics_.coordinates());
        std::array<double, kMaxSize> low, high;
        low.fill(std::numeric_limits<double>::infinity());
        high.fill(-std::numeric_limits<double>::infinity());
        for (int k = 0; k <= kDegree; ++k) {
            const double share = 0.5 * (1 - std::cos(kPi * k / kDegree));
            segment.value(k == kDegree ? segment.t1 : segment.t0 + share * (segment.t1 - segment.t0), probe_y_.data());
            for (std::size_t i = 0; i < n; ++i) {
                low[i] = std::min(low[i], probe_y_[i]);
                high[i] = std::max(high[i], probe_y_[i]);
            }
        }
        Range range;
        for (std::size_t i = 0; i < n; ++i) {
            range.middle[i] = 0.5 * (low[i] + high[i]);
            range.spread[i] = kLebesgue * 0.5 * (high[i] - low[i]);
        }
        return range;
    }

    // Looks at `count` equal pieces from the start of the segment to `end`, and at the valleys between.
    Event touch_between(const Segment& segment, double end, int count) {
        const double h = end - segment.t0;
        const bool everywhere = problem_.beam.model == ModelKind::exact;
        const auto probe = [&](double t) {
            const ContactState c = contact_at(segment, t, everywhere);
            return Guard{t, c.gap, c.gap_rate};
        };
        const ContactState first = contact_at(segment, segment.t0, true);
        Guard a{segment.t0, first.gap, first.gap_rate};
        for (int i = 1; i <= count; ++i) {
            const double t = i == count ? end : segment.t0 + h * i / count;
            const Guard b = probe(t);
            if (i == 1 && segment.t0 == phase_start_ && b.value <= 0) {
                // It starts on the surface and is below it soon: where was it above?
                if (!(a.rate < -kRestSpeed)) a = leaving(probe, a, b.t);
                if (!(a.value > 0) && !opens(segment, segment.t0)) return {EventKind::touch, segment.t0};
            } else if (i == 1 && segment.t0 == phase_start_) {
                a.value = std::max(a.value, 0.0);  // rounding of the release
                a.rate = std::max(a.rate, 0.0);
            }
            const auto at = first_fall(probe, a, b, gap_rounding());
            if (at && !opens(segment, *at)) return {EventKind::touch, *at};
            a = b;
        }
        return {};
    }

    // At an instant where the gap is below zero: by no more than the integrator's error, while the beam moves away, or
    // would within rounding, and is pulled away. After a lift the gap grows like t³ and the error comes first.
    bool opens(const Segment& segment, double t) {
        const ContactState c = contact_at(segment, t, false);
        if (c.gap_rate < -problem_.contact.approach_floor.value || c.gap < -gap_error()) return false;
        const double pull = scout_.free_gap_acceleration(t, probe_y_.data());
        return pull > 0 && (c.gap_rate > 0 || c.gap_rate * c.gap_rate < 2 * pull * gap_rounding());
    }

    // |g̈| within the bounds, while the disc is no deeper than half its radius and its centre no farther than `far` from
    // the foot: the terms of (S44) one by one. Infinite where the beam may bend so much that the foot runs away.
    double gap_acceleration_bound(const MotionBounds& b, double far) {
        const Cam& cam = *problem_.cam;
        const double reach = std::fabs(problem_.hub.radius) + scout_.model().length();
        const double near = 0.5 * cam.radius, arm = cam.eccentricity * std::fabs(cam.speed);
        if (!(b.curvature * far < kLeastFootStiffness)) return std::numeric_limits<double>::infinity();
        far = std::max(far, reach + cam.radius);
        const double speed = b.spin * reach + b.deflection_speed + arm;   // |w|, w = ṙ − Ḃ
        const double turn = b.spin + b.slope_speed;                       // |ṙ′|
        const double slide = (turn * far + speed) / kLeastFootStiffness;  // |ẋ|
        const double point = b.deflection_acceleration + b.spin_acceleration * reach + 2 * b.spin * b.deflection_speed +
                             b.spin * b.spin * reach + b.deflection_speed * b.slope_speed;  // |r̈|
        return (speed + slide) * speed / near + point + turn * slide + cam.eccentricity * cam.speed * cam.speed;
    }

    // Conservative advancement: from an open gap g with rate ġ nothing can touch before g + ġτ − ½Mτ² vanishes,
    // M ≥ |g̈|; so no touch is lost, however short. Once g + ġτ + ½Mτ² has a root the gap falls all the way to
    // it: Newton's method.                                                                         (S56)
    Event touch_by_advance(const Segment& segment, const MotionBounds& bounds) {
        const double h = segment.t1 - segment.t0;
        segment.value(segment.t0, probe_y_.data());
        const double reach = std::fabs(problem_.hub.radius) + scout_.model().length();
        const double speed =
            bounds.spin * reach + bounds.deflection_speed + problem_.cam->eccentricity * std::fabs(problem_.cam->speed);
        if (scout_.gap_lower_bound(segment.t0, probe_y_.data()) > h * speed) return {};

        double t = segment.t0;
        ContactState c = gap_.look(t, probe_y_.data(), true);
        const double far = problem_.cam->radius + scout_.offset() + std::max(c.gap, 0.0) + h * speed;
        const double most = gap_acceleration_bound(bounds, far);
        if (!std::isfinite(most)) return touch_by_resolving(segment);
        if (t == phase_start_) {
            if (!(c.gap_rate > kRestSpeed)) {
                // It hardly leaves: look closely at first.
                t = std::min(segment.t1, t + 1 / (scout_.highest_frequency() + bounds.spin + 1 / h));
                const Event event = touch_between(segment, t, 4);
                if (event.kind != EventKind::none) return event;
                c = gap_at(segment, t, true);
            }
            c.gap = std::max(c.gap, 0.0);  // rounding of the release
        }
        for (long looks = 0; looks < kMostLooks; ++looks) {
            if ((looks & kLooksTold) == kLooksTold) tell(segment.t0);
            const auto behind = static_cast<double>(looks) / kMostLooks;
            if (looks % kFirstLooks == kFirstLooks - 1 && !(t - segment.t0 > behind * h)) break;
            // It opens, and is below zero by rounding only.
            if (c.gap < 0 && c.gap_rate > 0 && c.gap > -kLowestBounce * problem_.beam.length) c.gap = 0;
            if (c.gap < 0 || (c.gap == 0 && c.gap_rate < 0)) return {EventKind::touch, t};
            const double falls = c.gap_rate * c.gap_rate - 2 * most * c.gap;
            if (c.gap_rate < 0 && falls > 0) {
                const double latest = t - (c.gap_rate + std::sqrt(falls)) / most;
                return falling(segment, t, c, latest);
            }
            const double safe = (c.gap_rate + std::sqrt(c.gap_rate * c.gap_rate + 2 * most * c.gap)) / most;
            const double next = t + std::max(safe, 1e-15 * t);
            if (next >= segment.t1) return {};
            t = next;
            c = gap_at(segment, t, false);
        }
        return touch_by_resolving(segment);
    }

    // Looks that resolve the fastest vibration.
    Event touch_by_resolving(const Segment& segment) {
        const double turns = (segment.t1 - segment.t0) * scout_.highest_frequency();
        return touch_between(segment, segment.t1, std::max(kMaxLooks, many(turns)));
    }

    // The gap falls from t on and vanishes before `latest`, which may lie beyond the segment.
    Event falling(const Segment& segment, double t, ContactState c, double latest) {
        double low = t, high = latest;
        for (int i = 0; i < 60; ++i) {
            double next = t - c.gap / c.gap_rate;
            if (!(next > low && next < high)) next = 0.5 * (low + high);
            if (next >= segment.t1) {
                next = segment.t1;
                c = gap_at(segment, next, false);
                if (c.gap > 0) return {};
            } else {
                c = gap_at(segment, next, false);
            }
            if (next == t || c.gap == 0 || std::fabs(c.gap) < 1e-16 * problem_.cam->radius)
                return {EventKind::touch, next};
            (c.gap > 0 ? low : high) = next;
            t = next;
        }
        return {EventKind::touch, t};
    }

    // Halving towards the start until the gap is open.
    template <class Probe>
    static Guard leaving(Probe&& probe, const Guard& start, double later) {
        for (int k = 1; k <= 24; ++k) {
            const Guard g = probe(start.t + std::ldexp(later - start.t, -k));
            if (g.value > 0) return g;
        }
        return start;
    }

    // Held on the cam until the force that holds it would have to pull.
    Event lift_in(const Segment& segment) {
        const int count = std::max(4, pieces(segment));
        const Instants time{segment.t0, segment.t1, count};
        const auto force = [&](double t) { return contact_at(segment, t, false).force; };
        std::array<double, kMaxLooks + 1> f;
        for (int i = 0; i <= count; ++i) f[static_cast<std::size_t>(i)] = force(time(i));
        // Rounding of a vanishing force does not lift.
        const double none = -1e-9 * (std::fabs(problem_.gravity) * scout_.model().mass() +
                                     *std::max_element(f.begin(), f.begin() + count + 1));
        for (int i = 0; i <= count; ++i) f[static_cast<std::size_t>(i)] -= none;
        const auto lifted = [&](double t) { return force(t) - none; };
        if (f[0] < 0) return {EventKind::lift, segment.t0};
        const int last = static_cast<int>(
            std::find_if(f.begin() + 1, f.begin() + count, [](double v) { return v < 0; }) - f.begin());
        if (const auto at = first_dip_of_samples(lifted, time, f.data(), last)) return {EventKind::lift, *at};
        if (f[static_cast<std::size_t>(last)] < 0)
            return {EventKind::lift,
                    find_root(lifted, time(last - 1), time(last), f[static_cast<std::size_t>(last) - 1],
                              f[static_cast<std::size_t>(last)])};
        return {};
    }

    // Equal steps through a segment.
    struct Instants {
        double t0, t1;
        int count;
        double operator()(int i) const { return i == count ? t1 : t0 + (t1 - t0) * i / count; }
    };

    // Where a guard without a rate, known by its values f[0…last] at the instants, falls below zero between two of them
    // that do not show it. The rates are differences; they are looked for unless the values stay farther from zero than
    // a curve bends that changes by them.
    template <class Value>
    static std::optional<double> first_dip_of_samples(Value&& value, const Instants& time, const double* f, int last) {
        constexpr double kDifference = 1e-2, kRounding = 1e-9;  // of the step; of the guard
        const double step = kDifference * (time.t1 - time.t0);
        const auto guard = [&](double t) {
            const double early = std::max(time.t0, t - step), late = std::min(time.t1, t + step);
            return Guard{t, value(t), (value(late) - value(early)) / (late - early)};
        };
        double bend = 0;
        for (int i = 1; i < last; ++i) bend = std::max(bend, std::fabs(f[i - 1] - 2 * f[i] + f[i + 1]));
        const double deep = kRounding * std::fabs(*std::max_element(f, f + last + 1));
        for (int i = 1; i <= last; ++i) {
            if (!(f[i - 1] > 0) || f[i] < 0 || (last > 1 && std::min(f[i - 1], f[i]) > bend)) continue;
            // A guard that starts at zero has the sign that was seen, not that of another rounding.
            Guard before = guard(time(i - 1)), after = guard(time(i));
            before.value = f[i - 1];
            after.value = f[i];
            if (const auto at = first_fall(guard, before, after, deep)) return at;
        }
        return std::nullopt;
    }

    // What is watched while touching, at one instant.
    struct Watch {
        Vec2 normal;
        Guard release;     // penetration and its rate
        double clamp = 1;  // 1 + D δ̇/δ̇₋: where it changes sign the never-negative force has a kink
        double grip = 1;   // positive while the grip holds (S36)
    };

    Watch watch(const Segment& segment, double t) {
        const ContactState c = contact_at(segment, t, false);
        Watch w{c.normal, {t, -c.gap, -c.gap_rate}, c.factor, 1};
        if (!scout_.has_bristle()) return w;
        if (phase_.grip == Grip::stick) {
            w.grip = scout_.static_coefficient() * c.force - std::fabs(c.friction);
        } else if (scout_.bristle_lags()) {
            w.grip = scout_.foot_speed(probe_y_.data(), c);
        } else {
            // Sliding: the speed of the bristle's foot along its direction, s v_t − μṄ/k.
            const double sign = phase_.grip == Grip::slide_plus ? 1 : -1;
            const double step = 1e-4 * (segment.t1 - segment.t0);
            const double early = std::max(segment.t0, t - step), late = std::min(segment.t1, t + step);
            const double growth =
                (contact_at(segment, late, false).force - contact_at(segment, early, false).force) / (late - early);
            w.grip = sign * c.slip - scout_.kinetic_coefficient() * growth / scout_.bristle_stiffness();
        }
        return w;
    }

    Event event_in_contact(const Segment& segment) {
        if (const TouchSamples* samples = segment.touch()) {
            switch (samples->ending) {
                case TouchSamples::Ending::open:
                    return {};
                case TouchSamples::Ending::release:
                    return {EventKind::release, segment.t1};
                case TouchSamples::Ending::clamp:
                    return {EventKind::clamp, segment.t1};
            }
        }
        const int count = std::max(pieces(segment), pieces_by_travel(segment, range_in(segment)));
        const Instants time{segment.t0, segment.t1, count};
        const auto release = [&](double t) { return watch(segment, t).release; };
        const auto grip_at = [&](double t) { return watch(segment, t).grip; };
        Event best;
        const auto offer = [&](EventKind kind, std::optional<double> t) {
            if (t && (best.kind == EventKind::none || *t < best.t)) best = {kind, *t};
        };
        Watch a = watch(segment, segment.t0);
        grip_.assign(static_cast<std::size_t>(count) + 1, a.grip);
        if (segment.t0 == phase_start_) a.release.value = std::max(a.release.value, 0.0);
        int looks = 0;
        while (looks < time.count && best.kind == EventKind::none) {
            const Watch b = watch(segment, time(++looks));
            if (dot(a.normal, b.normal) < 0 && b.release.value > 0) {
                why_ = Stop::passed_cam;
                throw StepFailure("the beam passed through the cam");
            }
            grip_[static_cast<std::size_t>(looks)] = b.grip;
            offer(EventKind::release, first_fall(release, a.release, b.release, gap_rounding()));
            offer(EventKind::clamp, clamp_in(segment, a, b));
            if (b.grip < 0 && may_change_grip())
                offer(EventKind::grip,
                      a.grip > 0 ? find_root(grip_at, a.release.t, b.release.t, a.grip, b.grip) : a.release.t);
            a = b;
        }
        if (!scout_.has_bristle()) return best;
        const auto at = first_dip_of_samples(grip_at, time, grip_.data(), looks);
        if (at && (best.kind == EventKind::none || *at < best.t) && may_change_grip()) return {EventKind::grip, *at};
        return best;
    }

    // Else it stays for this step: too many changes at one instant.
    bool may_change_grip() {
        if (idle_events_ <= kMostFlips) return true;
        ++unresolved_.grips;
        return false;
    }

    // Where the clamp of the force sets in or lets go.
    std::optional<double> clamp_in(const Segment& segment, const Watch& a, const Watch& b) {
        const NormalLaw& law = scout_.normal_law();
        if (!(law.damping > 0)) return std::nullopt;
        const double t0 = a.release.t, t1 = b.release.t, level = -phase_.approach / law.damping;
        const bool known = std::fabs(a.clamp) > kNoFactor;
        if (known) clamp_side_ = a.clamp > 0 ? 1 : -1;
        const auto look = [&](double t) { return watch(segment, t).release; };
        std::optional<double> at;
        for (int tries = 0; tries < 2; ++tries, clamp_side_ = -clamp_side_) {
            at = first_passing(look, a.release, b.release, level, clamp_side_, -kNoFactor * level);
            // Else it starts on the kink, and was taken to be on the wrong side of it.
            if (known || !at || *at - t0 > 1e-6 * (t1 - t0)) break;
        }
        const bool shows = known && std::fabs(b.clamp) > kNoFactor && (a.clamp > 0) != (b.clamp > 0);
        if (shows) {
            const double seen = find_root([&](double t) { return watch(segment, t).clamp; }, t0, t1, a.clamp, b.clamp);
            if (!at || !(*at < seen - 1e-9 * (t1 - t0))) at = seen;
        }
        return at;
    }

    // ---- transitions ----

    // Puts (t_, y_) at the event. False when the run ends before, or a shorter step was taken instead.
    bool reach(const Segment& segment, const Event& event) {
        const double start = segment.t0;
        if (event.t > start) {
            const Segment* ended = &integrator_->shorten(event.t);
            // The re-taken step is more accurate than the dense output the event was found on: one
            // Newton step in time puts the touch or release where it belongs.
            double at = event.t;
            if (ended->t1 == at && (event.kind == EventKind::touch || event.kind == EventKind::release)) {
                const ContactState c = contact_at(*ended, ended->t1, false);
                const double dt = -c.gap / c.gap_rate;
                if (std::isfinite(dt) && std::fabs(dt) < 1e-3 * (ended->t1 - start)) {
                    at = event.t + dt;
                    ended = &integrator_->shorten(at);
                }
            }
            if (ended->t1 < at) {
                take(*ended);
                return false;
            }
            // Also when the run ends before the event: a longer run looks at this shortened step, too.
            pass(*ended, start, true);
            idle_events_ = 0;
            return ended->t1 <= end_;
        }
        segment.value(start, y_.data());
        t_ = start;
        // Events without progress: a guard that cannot leave its surface.
        if (++idle_events_ > 50) {
            why_ = Stop::stuck;
            throw StepFailure("the contact changes its state again and again without time passing");
        }
        return true;
    }

    void change(const Event& event) {
        switch (event.kind) {
            case EventKind::none:
                break;
            case EventKind::clamp:  // same phase, new step: the kink lies between steps
                clamp_side_ = -clamp_side_;
                break;
            case EventKind::touch:
                problem_.contact.model == ContactModel::restitution ? strike() : touch();
                break;
            case EventKind::lift:
                lift();
                break;
            case EventKind::release:
                release();
                break;
            case EventKind::grip:
                change_grip();
                break;
        }
    }

    void touch() {
        // A first step as long as the impact could leave the beam inside the cam before any stage that counts
        // has felt the force: a twentieth of the way to the deepest point is felt by all.
        touch_at();
        const ContactState c = contact_now();
        integrator_->limit_first_step(0.05 * scout_.touch_time(t_, y_.data(), c, phase_.approach));
    }

    // What is left of the gap at an event: zero but for rounding, and exactly zero from here on.
    void take_out_gap() {
        phase_.gap_offset = 0;
        enter_phase();
        const double left = contact_now().gap;
        phase_.gap_offset = -left;
        enter_phase();
        unresolved_.gap = std::max(unresolved_.gap, std::fabs(left));
    }
    double gap_rounding() const { return kGapRounding * problem_.beam.length; }
    // What a step may leave of the gap.
    double gap_error() const {
        const Solver& solver = problem_.solver;
        return kStepErrors * (solver.rtol * (std::fabs(problem_.hub.radius) + problem_.beam.length) + solver.atol);
    }

    void touch_at() {
        take_out_gap();
        phase_.touching = true;
        clamp_side_ = 1;
        phase_start_ = t_;
        enter_phase();
        const double approach = -contact_now().gap_rate;
        const ApproachFloor& floor = problem_.contact.approach_floor;
        const bool same_collision = last_release_ && t_ - *last_release_ < problem_.contact.collision_gap;
        if (!same_collision) first_approach_ = approach;
        phase_.approach =
            std::max(floor.policy == ApproachFloorPolicy::first_touch ? first_approach_ : approach, floor.value);
        if (approach < floor.value) ++floored_;
        set_grip();
        enter_phase();
        tell_touch(contact_now());
    }

    // ---- impulsive contact ----

    void strike() {
        take_out_gap();
        const ContactState c = contact_now();
        const double approach = -c.gap_rate;
        const Compliance compliance = scout_.compliance(t_, y_.data(), c);
        const auto resolve = [&](double restitution) {
            return resolve_impact(compliance, c.gap_rate, c.slip, scout_.kinetic_coefficient(), restitution,
                                  problem_.contact.law);
        };
        ImpactResult impact = resolve(problem_.contact.restitution);
        if (sum_up_chatter(c, impact, resolve(0))) return;
        // A rebound that the integrator cannot tell from a touch at the same instant has ended, too.
        // Nor will bounces end that rounding of the gap keeps from falling.
        const double pull = -scout_.free_gap_acceleration(t_, y_.data());
        const bool low = pull > 0 && impact.v_n * impact.v_n < 2 * pull * kLowestBounce * problem_.beam.length;
        const bool chatter =
            impact.v_n < kChatterShare * problem_.contact.approach_floor.value || (low && impact.v_n >= last_rebound_);
        const bool slow = chatter || idle_events_ > kMostFlips;
        last_rebound_ = impact.v_n;
        phase_start_ = t_;
        // The gap opens: that it was below zero is rounding, and no strike.
        if (!slow && !(approach > 0)) return;
        if (!chatter && slow) ++unresolved_.strikes;
        tell_touch(c);
        if (slow) impact = resolve(0);
        if (approach > 0) scout_.strike(t_, y_.data(), c, impact);
        const double falls = -scout_.free_gap_acceleration(t_, y_.data());
        if (slow && falls > 0) {
            phase_.touching = phase_.held = true;
            enter_phase();
            ++chatters_;
            return;
        }
        // A step much longer than the bounce errs by more than the bounce is high: bounces would never die out.
        if (falls > 0) integrator_->limit_first_step(kBounces * 2 * impact.v_n / falls);
        tell_rebound(y_, c, impact);
    }

    void tell_rebound(const std::vector<double>& y, ContactState c, const ImpactResult& impact) {
        c.gap_rate = impact.v_n;
        c.slip = impact.v_t;
        tell_release(y, c);
        last_release_ = t_;
    }

    // Bounces under a steady pull a, each of which keeps the share e of its speed, come to rest after
    // T = 2v/(a(1 − e)). A plastic strike that is held from then on gives the beam the same impulse with the same
    // moment in time, so the motion goes on by it; the contact counts as sustained after T.             (S57)
    // False: the bounces have to be followed.
    bool sum_up_chatter(const ContactState& c, const ImpactResult& impact, const ImpactResult& plastic) {
        const double approach = -c.gap_rate, rebound = impact.v_n;
        if (!(rebound > 0 && rebound < approach && rebound < kSummedShare * problem_.contact.approach_floor.value))
            return false;
        std::vector<double> settled = y_;
        scout_.strike(t_, settled.data(), c, plastic);
        const double pull = -scout_.free_gap_acceleration(t_, settled.data());
        const double lasts = 2 * rebound / (pull * (1 - rebound / approach));
        const double turns = std::fabs(scout_.model().hub_rate()) + std::fabs(problem_.cam->speed);
        if (!(pull > 0 && lasts * (scout_.highest_frequency() + turns) < kBriefChatter)) return false;

        const Phase flight = phase_;
        phase_.touching = phase_.held = true;
        enter_phase();
        std::vector<double> rates(y_.size());
        scout_.rhs(t_, settled.data(), rates.data());
        for (std::size_t i = 0; i < rates.size(); ++i) probe_y_[i] = settled[i] + lasts * rates[i];
        const double later = -scout_.free_gap_acceleration(t_ + lasts, probe_y_.data());
        if (!(std::fabs(later - pull) < kSteadyPull * pull)) {
            phase_ = flight;
            enter_phase();
            return false;
        }
        tell_touch(c);
        std::vector<double> struck = y_;
        scout_.strike(t_, struck.data(), c, impact);
        tell_rebound(struck, c, impact);
        y_ = std::move(settled);
        phase_start_ = t_;
        settles_ = t_ + lasts;
        ++chatters_;
        return true;
    }

    void lift() {
        if (!settles_) tell_release(y_, contact_now());
        settles_.reset();
        phase_.touching = phase_.held = false;
        take_out_gap();
        phase_start_ = t_;
        last_release_ = t_;
        enter_phase();
    }

    // Grip at touch: sliding unless the bristle can follow. For n > 1 the normal force starts flat, so
    // any slip breaks it at once, as it does with a dashpot; for n = 1 both forces grow linearly.
    void set_grip() {
        phase_.grip = Grip::stick;
        if (!scout_.has_bristle()) return;
        y_[static_cast<std::size_t>(2 * scout_.coordinates())] = 0;
        enter_phase();
        const ContactState c = contact_now();
        const double growth =
            problem_.contact.exponent > 1 ? 0 : scout_.normal_law().stiffness * std::max(0.0, -c.gap_rate);
        const bool breaks = scout_.bristle_damped() ||
                            scout_.bristle_stiffness() * std::fabs(c.slip) > scout_.static_coefficient() * growth;
        if (breaks && c.slip != 0 && !(c.gap < 0)) phase_.grip = c.slip > 0 ? Grip::slide_plus : Grip::slide_minus;
        enter_phase();
    }

    void change_grip() {
        const ContactState c = contact_now();
        double& z = y_[static_cast<std::size_t>(2 * scout_.coordinates())];
        // Without a dashpot the bristle follows the sliding force at once: no state until it sticks again.
        if (phase_.grip == Grip::stick) {
            phase_.grip = c.friction < 0 ? Grip::slide_plus : Grip::slide_minus;
            if (!scout_.bristle_lags()) z = 0;
        } else {
            if (!scout_.bristle_lags()) z = scout_.caught_bristle(c);
            phase_.grip = Grip::stick;
        }
        enter_phase();
    }

    void release() {
        const ContactState c = contact_now();
        tell_release(y_, c);
        phase_.touching = false;
        // Rounding must not look like a new touch: the gap of this flight starts at zero.
        take_out_gap();
        phase_start_ = t_;
        last_release_ = t_;
        if (scout_.has_bristle()) y_[static_cast<std::size_t>(2 * scout_.coordinates())] = 0;
        enter_phase();
    }

    // ---- the end ----

    Tally tally() const {
        Tally all;
        Counters& c = all.counters;
        c.steps = integrator_->counters.steps;
        c.rejected = integrator_->counters.rejected;
        c.rhs_evaluations = integrator_->counters.rhs;
        c.jacobians = integrator_->counters.jacobians;
        c.gap_evaluations = dynamics_.gap_evaluations + scout_.gap_evaluations;
        all.fallbacks = unresolved_;
        all.fallbacks.steps = integrator_->counters.fallback_steps;
        all.fallbacks.handed_over = integrator_->counters.handed_over;
        all.fallbacks.method = integrator_->counters.fallback;
        all.floored = floored_;
        all.chatters = chatters_;
        return all;
    }

    std::string explain(const StepFailure& failure) {
        if (dynamics_.inertia_lost()) why_ = Stop::inertia_lost;
        enter_phase();
        return sim::explain({why_, failure.what(), t_, last_step_, whole_}, scout_, y_.data());
    }

    const Problem& problem_;
    const Progress& progress_;
    TrajectoryWriter* keep_;
    System dynamics_, scout_;
    GapProbe gap_;  // of the scout
    Audience audience_;
    std::unique_ptr<Integrator> integrator_;
    std::vector<double> y_, probe_y_, kinks_, grip_;  // grip_: the guard at the looks into one step
    Phase phase_;
    double end_ = 0, t_ = 0, phase_start_ = 0, first_approach_ = 0;
    std::optional<double> last_release_, settles_;  // settles_: when the chatter that was summed up is over
    long floored_ = 0, chatters_ = 0;
    Fallbacks unresolved_;
    double clamp_side_ = 1;  // of the kink of the clamp where it was last away from it: +1 pushes
    int idle_events_ = 0;
    double last_rebound_ = 0;  // [m/s]
    double last_step_ = 0;     // [s]
    double whole_ = 0;         // steps that the whole run would take at the pace so far, when last looked
    long next_pace_ = kFirstPace, paced_ = 0;  // steps at the next such look and at the last
    double paced_time_ = 0;                    // [s]
    Stop why_ = Stop::method;                  // of a failure
    bool started_ = false;                     // a state to begin with was found
    const Audience::TallySource tally_source_ = [this] { return tally(); };
};

std::vector<Result> integrate(const Problem& problem, std::span<const Request> requests, const Progress& progress,
                              TrajectoryWriter* keep, Effort* effort) {
    std::optional<Run> run;
    try {
        run.emplace(problem, requests, progress, keep);
    } catch (const StepFailure& failure) {  // the model itself
        throw SolverError(fmt::format("at the start: {}; use fewer modes", failure.what()), 0, {});
    }
    std::vector<Result> results = run->go();
    if (effort) effort->add(run->counters());
    return results;
}

// The run that the horizon compares with. It may fail, or spend its budget of steps, where the motion itself did not:
// then the same method at a tighter tolerance takes its place, as far as that comes.
Result comparison_run(const Problem& problem, const Request& angle, const Progress& progress, Effort* effort,
                      Comparison& compared) {
    const auto run = [&] {
        return std::move(integrate(compared.problem, {&angle, 1}, progress, nullptr, effort).front());
    };
    try {
        return run();
    } catch (const SolverError& error) {
        if (compared.same_method) {
            if (error.partials.empty()) throw;
            return error.partials.front();
        }
    }
    compared = tighter_comparison(problem);
    return comparison_run(problem, angle, progress, effort, compared);
}

// `motion(requests)` gives the results of the problem itself. A horizon needs one run more.
template <class Motion>
std::vector<Result> with_horizons(const Problem& problem, std::span<const Request> requests, const Progress& progress,
                                  Effort* effort, Motion&& motion) {
    double end = -1;
    for (const Request& request : requests)
        if (request.horizon) end = std::max(end, end_of(request));
    if (end < 0) return motion(requests);
    std::vector<Request> all(requests.begin(), requests.end());
    all.push_back(horizon_request(problem, end));
    std::vector<Result> results = motion(all);
    const Request& angle = all.back();
    Comparison compared = comparison(problem, end);
    const Result other = comparison_run(problem, angle, progress, effort, compared);
    const Result plain = std::move(results.back());
    results.pop_back();
    for (std::size_t i = 0; i < requests.size(); ++i)
        if (requests[i].horizon) tell_reproducibility(problem, angle, plain, other, compared, results[i]);
    return results;
}

void require_valid(const Problem& problem) {
    for (const Finding& finding : validate(problem))
        if (finding.fatal) throw std::invalid_argument(finding.path + ": " + finding.message);
}

template <class Work>
std::vector<Result> timed(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    std::vector<Result> results = work();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    for (Result& result : results) result.wall_seconds = seconds;
    return results;
}

}  // namespace

SolverError::SolverError(const std::string& what, double last_good_time, std::vector<Result> partial_results)
    : std::runtime_error(what), last_time(last_good_time), partials(std::move(partial_results)) {}

void Effort::add(const Counters& counters) {
    if (counters.steps > 0) ++integrations;  // else the initial state was all
    spent.steps += counters.steps;
    spent.rejected += counters.rejected;
    spent.rhs_evaluations += counters.rhs_evaluations;
    spent.gap_evaluations += counters.gap_evaluations;
    spent.jacobians += counters.jacobians;
}

void Effort::add(const Effort& more) {
    const long together = integrations + more.integrations;
    add(more.spent);
    integrations = together;
}

std::vector<Result> simulate(const Problem& problem, std::span<const Request> requests, const Progress& progress,
                             TrajectoryWriter* keep, Effort* effort) {
    require_valid(problem);
    return timed([&] {
        return with_horizons(problem, requests, progress, effort, [&](std::span<const Request> all) {
            return integrate(problem, all, progress, keep, effort);
        });
    });
}

Result simulate(const Problem& problem, const Request& request, const Progress& progress) {
    return std::move(simulate(problem, {&request, 1}, progress).front());
}

std::vector<Result> replay(const Problem& problem, const Trajectory& trajectory, std::span<const Request> requests,
                           const Progress& progress, Effort* effort) {
    require_valid(problem);
    return timed([&] {
        return with_horizons(problem, requests, progress, effort, [&](std::span<const Request> all) {
            Audience audience(System(problem), all);
            trajectory.play(problem, audience);
            return audience.results();
        });
    });
}

}  // namespace beamcam::sim
