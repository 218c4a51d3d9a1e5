#include "sim/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "sim/initial.hpp"
#include "sim/numerics.hpp"
#include "sim/observe.hpp"
#include "sim/system.hpp"

namespace beamcam::sim {
namespace {

// A function of time and its rate, positive where nothing happens.
struct Guard {
    double t = 0, value = 0, rate = 0;
};

// The first instant in (a, b] where the guard falls through zero; `probe(t)` gives a Guard. A dip
// between the ends is found from the rates: a cubic through both ends predicts its depth.
template <class Probe>
std::optional<double> first_fall(Probe&& probe, const Guard& a, const Guard& b, int depth) {
    const auto value = [&](double t) { return probe(t).value; };
    const auto rate = [&](double t) { return probe(t).rate; };
    if (a.value < 0 || (a.value == 0 && a.rate < 0)) return a.t;
    if (b.value < 0) {
        if (a.value > 0) {
            // A short excursion may hide in front of a later one: halve a few times.
            if (depth > 0) {
                const Guard middle = probe(0.5 * (a.t + b.t));
                if (const auto early = first_fall(probe, a, middle, depth - 1)) return early;
                return find_root(value, middle.t, b.t, middle.value, b.value);
            }
            return find_root(value, a.t, b.t, a.value, b.value);
        }
        // It starts on the surface: leaves it first, or falls at once.
        if (!(a.rate > 0) || !(b.rate < 0)) return a.rate > 0 ? std::optional(b.t) : std::optional(a.t);
        const double top = find_root(rate, a.t, b.t, a.rate, b.rate);
        const double highest = value(top);
        if (!(highest > 0)) return a.t;
        return find_root(value, top, b.t, highest, b.value);
    }
    if (!(a.rate < 0 && b.rate > 0)) return std::nullopt;
    // A valley between the ends. With slopes −r₀, r₁ over a span h a cubic cannot fall by more than
    // h r₀ below a, nor by more than h r₁ below b.
    const double span = b.t - a.t;
    if (a.value + a.rate * span > 0 && b.value - b.rate * span > 0) return std::nullopt;
    const double bottom = find_root(rate, a.t, b.t, a.rate, b.rate);
    const double lowest = value(bottom);
    if (!(lowest < 0)) return std::nullopt;
    return find_root(value, a.t, bottom, a.value, lowest);
}

enum class EventKind { none, touch, release, clamp, grip, lift };

// Model `restitution`: a rebound slower than this share of the approach floor ends the chatter in
// sustained contact. A bouncing point then rests at most 2v/(g(1 − e)) too early (MODEL.md §9).
constexpr double kChatterShare = 1e-3;

constexpr int kMaxLooks = 16;          // into one step, for events
constexpr double kLargestSlope = 0.3;  // [rad] beyond which the modal models' u ≈ −½∫v′² misses 2 %
constexpr double kMostPieces = 1e5;    // of one step, for touches
constexpr double kRestSpeed = 1e-12;   // [m/s] slower is rounding
struct Event {
    EventKind kind = EventKind::none;
    double t = 0;
};

class Run {
  public:
    Run(const Problem& problem, const Request& request, const Progress& progress)
        : problem_(problem),
          request_(request),
          progress_(progress),
          dynamics_(problem),
          scout_(problem),
          recorder_(problem, request, result_) {
        end_ = request.end_time;
        for (const TableRequest& table : request.tables)
            for (double t : table.times) end_ = std::max(end_, t);
        for (const PoseRequest& poses : request.poses)
            for (double t : poses.times) end_ = std::max(end_, t);
        for (const PointRequest& points : request.points)
            for (double t : points.times) end_ = std::max(end_, t);
        const Solver& solver = problem.solver;
        // `auto` keeps a reserve: local errors of a third of the tolerance, so that what adds up over
        // many impacts stays within the ledger's bound of ten times rtol.
        const double share = solver.method == Method::automatic ? 1.0 / 3 : 1;
        const bool rk8 = solver.method == Method::automatic || solver.method == Method::rk8;
        integrator_ = rk8 ? make_rk8(dynamics_, share * solver.rtol, share * solver.atol)
                          : make_sundials(solver.method, dynamics_, solver.rtol, solver.atol);
        y_.resize(static_cast<std::size_t>(dynamics_.size));
        probe_y_.resize(y_.size());
    }

    Result go() {
        const auto clock = std::chrono::steady_clock::now();
        try {
            integrate();
        } catch (const StepFailure& failure) {
            finish(clock);
            throw SolverError(explain(failure), t_, std::move(result_));
        }
        finish(clock);
        return std::move(result_);
    }

  private:
    void integrate() {
        const InitialState start = initial_state(problem_);
        y_ = start.y;
        t_ = 0;
        kinks_ = dynamics_.drive().kinks();
        phase_ = start.phase;
        enter_phase();
        recorder_.begin(phase_, y_);
        integrator_->stop_at(next_kink());
        if (phase_.touching) {
            set_grip();
            recorder_.touch(0, y_.data(), contact_now());
        }
        bool more = start_segment();
        long steps = 0;
        while (more) {
            const Segment* segment = &integrator_->step();
            if (progress_ && (++steps & 255) == 0 && !progress_(std::min(segment->t1, end_))) throw Interrupted();
            const Event event = first_event(*segment);
            if (event.kind != EventKind::none && event.t <= end_) {
                handle(*segment, event);
                pass_kinks();
                more = t_ < end_;
                if (!more) observe_point();
                if (more) start_segment();
                continue;
            }
            more = segment->t1 < end_;
            const double from = segment->t0, to = std::min(segment->t1, end_);
            recorder_.stretch({segment, from, to, !more});
            segment->value(to, y_.data());
            t_ = to;
            if (more && segment->t1 >= next_kink()) {
                pass_kinks();
                start_segment();
            }
        }
    }

    double next_kink() const { return kinks_.empty() ? std::numeric_limits<double>::infinity() : kinks_.front(); }

    // An event may fall on a kink, or so near before it that no step fits between.
    void pass_kinks() {
        while (!kinks_.empty() && kinks_.front() - t_ <= 1e-14 * std::fabs(t_)) kinks_.erase(kinks_.begin());
        integrator_->stop_at(next_kink());
    }

    bool start_segment() {
        integrator_->start(t_, y_.data());
        if (end_ > t_) return true;
        observe_point();
        return false;
    }

    // The end of the run falls on a point without a segment of its own.
    struct PointSegment final : Segment {
        explicit PointSegment(const std::vector<double>& state) : y(state) {}
        void value(double, double* out) const override { std::copy(y.begin(), y.end(), out); }
        const std::vector<double>& y;
    };
    void observe_point() {
        PointSegment point(y_);
        point.t0 = point.t1 = t_;
        recorder_.stretch({&point, t_, t_, true});
    }

    void enter_phase() {
        dynamics_.set_phase(phase_);
        scout_.set_phase(phase_);
    }

    // ---- guards ----

    ContactState contact_at(const Segment& segment, double t, bool search) {
        segment.value(t, probe_y_.data());
        return scout_.contact(t, probe_y_.data(), search);
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

    Event touch_in(const Segment& segment) {
        // Far away: what the gap can lose in this step is less than it is at both ends.
        const double h = segment.t1 - segment.t0;
        segment.value(segment.t1, probe_y_.data());
        const double gap1 = scout_.gap_lower_bound(segment.t1, probe_y_.data()),
                     speed1 = scout_.gap_speed_bound(segment.t1, probe_y_.data());
        segment.value(segment.t0, probe_y_.data());
        const double gap0 = scout_.gap_lower_bound(segment.t0, probe_y_.data()),
                     speed0 = scout_.gap_speed_bound(segment.t0, probe_y_.data());
        if (std::min(gap0, gap1) > 2 * h * (std::max(speed0, speed1) + h * problem_.gravity)) return {};

        const bool everywhere = problem_.beam.model == ModelKind::exact;
        const auto probe = [&](double t) {
            const ContactState c = contact_at(segment, t, everywhere);
            return Guard{t, c.gap, c.gap_rate};
        };
        // A long step may carry the beam through the cam and out again: no piece moves it by more than half a radius.
        const double travel = h * std::max(speed0, speed1) / (0.5 * problem_.cam->radius);
        const int count = std::max(pieces(segment), static_cast<int>(std::min(std::ceil(travel), kMostPieces)));
        const ContactState first = contact_at(segment, segment.t0, true);
        Guard a{segment.t0, first.gap, first.gap_rate};
        for (int i = 1; i <= count; ++i) {
            const double t = i == count ? segment.t1 : segment.t0 + h * i / count;
            const Guard b = probe(t);
            if (i == 1 && segment.t0 == phase_start_ && b.value <= 0) {
                // It starts on the surface and is below it soon: where was it above?
                if (!(a.rate < -kRestSpeed)) a = leaving(probe, a, b.t);
                if (!(a.value > 0)) return {EventKind::touch, segment.t0};
            } else if (i == 1 && segment.t0 == phase_start_) {
                a.value = std::max(a.value, 0.0);  // rounding of the release
                a.rate = std::max(a.rate, 0.0);
            }
            if (const auto at = first_fall(probe, a, b, 0)) return {EventKind::touch, *at};
            a = b;
        }
        return {};
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

    // Held on the cam until the force that holds it would have to pull. A short dip below zero hides
    // between samples: where their parabola comes near zero the dip is looked into.
    Event lift_in(const Segment& segment) {
        const int count = std::max(4, pieces(segment));
        const double h = segment.t1 - segment.t0;
        const auto time = [&](int i) { return i == count ? segment.t1 : segment.t0 + h * i / count; };
        const auto force = [&](double t) { return contact_at(segment, t, false).force; };
        std::array<double, kMaxLooks + 1> f;
        for (int i = 0; i <= count; ++i) f[static_cast<std::size_t>(i)] = force(time(i));
        // Rounding of a vanishing force does not lift.
        const double none = -1e-9 * (std::fabs(problem_.gravity) * scout_.model().mass() +
                                     *std::max_element(f.begin(), f.begin() + count + 1));
        for (int i = 0; i <= count; ++i) f[static_cast<std::size_t>(i)] -= none;
        const auto lifted = [&](double t) { return force(t) - none; };
        if (f[0] < 0) return {EventKind::lift, segment.t0};
        for (int i = 1; i <= count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            if (f[k] < 0) return {EventKind::lift, find_root(lifted, time(i - 1), time(i), f[k - 1], f[k])};
            const std::size_t m = std::clamp<std::size_t>(k, 1, static_cast<std::size_t>(count) - 1);
            const double bend = f[m - 1] - 2 * f[m] + f[m + 1], lean = f[m + 1] - f[m - 1];
            if (!(bend > 0) || f[m] - lean * lean / (8 * bend) > 0.05 * (f[m - 1] + f[m + 1])) continue;
            const auto [at, highest] = find_peak([&](double t) { return -lifted(t); }, time(i - 1), time(i));
            if (highest > 0) return {EventKind::lift, find_root(lifted, time(i - 1), at, f[k - 1], -highest)};
        }
        return {};
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
        const double h = segment.t1 - segment.t0;
        const int count = pieces(segment);
        const auto release = [&](double t) { return watch(segment, t).release; };
        Watch a = watch(segment, segment.t0);
        if (segment.t0 == phase_start_) a.release.value = std::max(a.release.value, 0.0);
        for (int i = 1; i <= count; ++i) {
            const double t0 = a.release.t, t1 = i == count ? segment.t1 : segment.t0 + h * i / count;
            const Watch b = watch(segment, t1);
            if (dot(a.normal, b.normal) < 0 && b.release.value > 0) {
                sunk_ = true;
                throw StepFailure("the beam passed through the cam");
            }
            Event best;
            const auto offer = [&](EventKind kind, double t) {
                if (best.kind == EventKind::none || t < best.t) best = {kind, t};
            };
            if (const auto at = first_fall(release, a.release, b.release, 0)) offer(EventKind::release, *at);
            if (changes(a.clamp, b.clamp))
                offer(EventKind::clamp,
                      find_root([&](double t) { return watch(segment, t).clamp; }, t0, t1, a.clamp, b.clamp));
            if (b.grip < 0)
                offer(EventKind::grip,
                      a.grip > 0 ? find_root([&](double t) { return watch(segment, t).grip; }, t0, t1, a.grip, b.grip)
                                 : t0);
            if (best.kind != EventKind::none) return best;
            a = b;
        }
        return {};
    }

    static bool changes(double a, double b) { return std::fabs(a) > 1e-9 && std::fabs(b) > 1e-9 && (a > 0) != (b > 0); }

    // ---- transitions ----

    void handle(const Segment& segment, Event event) {
        const double start = segment.t0;
        if (event.t > start) {
            const Segment* ended = &integrator_->shorten(event.t);
            // The re-taken step is more accurate than the dense output the event was found on: one
            // Newton step in time puts the touch or release where it belongs.
            if (event.kind == EventKind::touch || event.kind == EventKind::release) {
                const ContactState c = contact_at(*ended, ended->t1, false);
                const double dt = -c.gap / c.gap_rate;
                if (std::isfinite(dt) && std::fabs(dt) < 1e-3 * (ended->t1 - start))
                    ended = &integrator_->shorten(event.t + dt);
            }
            recorder_.stretch({ended, start, ended->t1, false});
            t_ = ended->t1;
            ended->value(t_, y_.data());
            idle_events_ = 0;
        } else {
            segment.value(start, y_.data());
            t_ = start;
            // Events without progress: a guard that cannot leave its surface.
            if (++idle_events_ > 50)
                throw StepFailure("the contact changes its state again and again without time passing");
        }
        switch (event.kind) {
            case EventKind::none:
                break;
            case EventKind::clamp:
                return;  // same phase, new step: the kink lies between steps
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
        recorder_.phase(phase_);
    }

    void touch() {
        // A first step as long as the impact could leave the beam inside the cam before any stage that counts
        // has felt the force: a twentieth of the way to the deepest point is felt by all.
        touch_at();
        const ContactState c = contact_now();
        integrator_->limit_first_step(0.05 * scout_.touch_time(t_, y_.data(), c, phase_.approach));
    }

    void touch_at() {
        phase_.gap_offset = 0;
        enter_phase();
        const double raw = contact_now().gap;
        phase_.touching = true;
        phase_.gap_offset = -raw;
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
        recorder_.phase(phase_);
        recorder_.touch(t_, y_.data(), contact_now());
    }

    // ---- impulsive contact ----

    void strike() {
        phase_.gap_offset = 0;
        enter_phase();
        ContactState c = contact_now();
        phase_.gap_offset = -c.gap;
        enter_phase();
        c = contact_now();
        const double approach = -c.gap_rate;
        recorder_.touch(t_, y_.data(), c);
        const double chatter = kChatterShare * problem_.contact.approach_floor.value;
        const Compliance compliance = scout_.compliance(t_, y_.data(), c);
        const double e = problem_.contact.restitution;
        ImpactResult impact =
            resolve_impact(compliance, c.gap_rate, c.slip, scout_.kinetic_coefficient(), e, problem_.contact.law);
        const bool slow = impact.v_n < chatter;
        if (slow)
            impact =
                resolve_impact(compliance, c.gap_rate, c.slip, scout_.kinetic_coefficient(), 0, problem_.contact.law);
        if (approach > 0) scout_.strike(t_, y_.data(), c, impact);
        phase_start_ = t_;
        if (slow && scout_.free_gap_acceleration(t_, y_.data()) < 0) {
            phase_.touching = phase_.held = true;
            enter_phase();
            ++chatters_;
            return;
        }
        ContactState after = c;
        after.gap_rate = impact.v_n;
        after.slip = impact.v_t;
        recorder_.release(t_, y_.data(), after);
        last_release_ = t_;
    }

    void lift() {
        const ContactState c = contact_now();
        recorder_.release(t_, y_.data(), c);
        phase_.touching = phase_.held = false;
        phase_.gap_offset = 0;
        enter_phase();
        phase_.gap_offset = -contact_now().gap;
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
        const bool breaks = scout_.bristle_lags() ||
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
            if (!scout_.bristle_lags()) z = scout_.sliding_bristle(c);
            phase_.grip = Grip::stick;
        }
        enter_phase();
    }

    void release() {
        const ContactState c = contact_now();
        recorder_.release(t_, y_.data(), c);
        phase_.touching = false;
        phase_.gap_offset = 0;
        enter_phase();
        // Rounding must not look like a new touch: the gap of this flight starts at zero.
        phase_.gap_offset = -contact_now().gap;
        phase_start_ = t_;
        last_release_ = t_;
        if (scout_.has_bristle()) y_[static_cast<std::size_t>(2 * scout_.coordinates())] = 0;
        enter_phase();
    }

    // ---- the end ----

    void finish(std::chrono::steady_clock::time_point clock) {
        recorder_.end(t_, y_.data());
        Counters& c = result_.counters;
        c.steps = integrator_->counters.steps;
        c.rejected = integrator_->counters.rejected;
        c.rhs_evaluations = integrator_->counters.rhs;
        c.jacobians = integrator_->counters.jacobians;
        c.gap_evaluations = dynamics_.gap_evaluations + scout_.gap_evaluations;
        result_.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
        tell_chatter();
        tell_ledger();
        tell_slopes();
        if (floored_ > 0)
            result_.warnings.push_back(
                fmt::format("{} of {} touches began slower than contact.approach_floor.value = {} m/s; their "
                            "dissipation uses that floor",
                            floored_, result_.impacts.size(), problem_.contact.approach_floor.value));
    }

    // Ten times what was asked for is the promise of `auto`; whatever misses it says so.
    void tell_ledger() {
        const double limit = 10 * problem_.solver.rtol * result_.energy_scale;
        if (problem_.beam.model == ModelKind::paper || !(result_.energy_residual_max > limit)) return;
        result_.warnings.push_back(
            fmt::format("the energy ledger closes only to {:.2g} J of {:.3g} J, more than 10 times rtol = {:g}: "
                        "tighten solver.rtol{}",
                        result_.energy_residual_max, result_.energy_scale, problem_.solver.rtol,
                        problem_.solver.method == Method::automatic ? "" : ", or use \"method\": \"auto\""));
    }

    // ∫v″² ≥ (slope at the tip)²/L: an upper bound of the slope from the bending energy, whatever the shape.
    void tell_slopes() {
        const Beam& beam = problem_.beam;
        if (beam.model == ModelKind::exact || beam.model == ModelKind::rigid) return;
        const double slope = std::sqrt(2 * recorder_.largest_elastic() * beam.length / beam.bending_stiffness());
        if (slope > kLargestSlope)
            result_.warnings.push_back(
                fmt::format("the beam bends through angles up to about {:.2g} rad; {} holds for small ones: use "
                            "\"model\": \"exact\"",
                            slope, name(beam.model)));
    }

    void tell_chatter() {
        if (chatters_ == 0) return;
        const double speed = kChatterShare * problem_.contact.approach_floor.value;
        result_.warnings.push_back(
            fmt::format("chatter ended {} time{} in sustained contact, at rebounds below {:g} m/s "
                        "(contact.approach_floor.value times {:g}): energy "
                        "left out per end at most {:.2g} J",
                        chatters_, chatters_ == 1 ? "" : "s", speed, kChatterShare,
                        0.5 * problem_.beam.line_density() * problem_.beam.length * speed * speed));
    }

    std::string explain(const StepFailure& failure) const {
        const std::string when = fmt::format("at t = {:.9g} s", t_);
        if (dynamics_.inertia_lost())
            return fmt::format(
                "{}: the {} model with {} {} modes lost its positive inertia (the hub is too light for these shapes); "
                "use "
                "\"basis\": \"hub-beam\", fewer modes, or \"model\": \"second-order\"",
                when, name(problem_.beam.model), problem_.beam.modes, name(resolved_basis(problem_)));
        if (sunk_)
            return fmt::format(
                "{}: the beam was pressed through the centre of the cam; the contact is too soft (stiffness {:g} "
                "N/m^{:g}), or the drive of the hub leaves no way around the cam: raise contact.stiffness or change "
                "the "
                "drive",
                when, contact_stiffness(problem_), problem_.contact.exponent);
        return fmt::format(
            "{}: {}; contact stiffness {:g} N/m^{:g}, {} modes up to {:.3g} rad/s, rtol {:g}: a softer contact, fewer "
            "modes or a "
            "looser tolerance needs larger steps",
            when, failure.what(), contact_stiffness(problem_), problem_.contact.exponent, problem_.beam.modes,
            dynamics_.highest_frequency(), problem_.solver.rtol);
    }

    const Problem& problem_;
    const Request& request_;
    const Progress& progress_;
    Result result_;
    System dynamics_, scout_;
    Recorder recorder_;
    std::unique_ptr<Integrator> integrator_;
    std::vector<double> y_, probe_y_, kinks_;
    Phase phase_;
    double t_ = 0, end_ = 0, phase_start_ = 0, first_approach_ = 0;
    std::optional<double> last_release_;
    long floored_ = 0, chatters_ = 0;
    int idle_events_ = 0;
    bool sunk_ = false;
};

// Until when θ is the same to kHorizonError at the asked tolerance and at one a hundred times tighter.
constexpr double kHorizonError = 1e-6;  // [rad], relative to max(1, |θ|)
constexpr double kHorizonRate = 1000;   // [Hz] of comparison

double horizon(const Problem& problem, double end_time, const Progress& progress) {
    Request request;
    TableRequest table;
    table.channels = {{ChannelKind::theta, 0}};
    const auto rows = static_cast<long>(std::floor(end_time * kHorizonRate));
    for (long k = 0; k <= rows; ++k) table.times.push_back(static_cast<double>(k) / kHorizonRate);
    table.times.push_back(end_time);
    request.tables.push_back(table);
    Problem tighter = problem;
    tighter.solver.rtol = std::max(1e-13, problem.solver.rtol / 100);
    tighter.solver.atol = problem.solver.atol / 100;
    Run plain_run(problem, request, progress);
    Run tight_run(tighter, request, progress);
    const Result plain = plain_run.go(), tight = tight_run.go();
    for (std::size_t i = 0; i < table.times.size(); ++i) {
        const double a = plain.tables[0].values[0][i], b = tight.tables[0].values[0][i];
        if (std::fabs(a - b) > kHorizonError * std::max(1.0, std::fabs(b))) return i > 0 ? table.times[i - 1] : 0;
    }
    return end_time;
}

}  // namespace

SolverError::SolverError(const std::string& what, double last_good_time, Result partial_result)
    : std::runtime_error(what), last_time(last_good_time), partial(std::move(partial_result)) {}

Result simulate(const Problem& problem, const Request& request, const Progress& progress) {
    for (const Finding& finding : validate(problem))
        if (finding.fatal) throw std::invalid_argument(finding.path + ": " + finding.message);
    Run run(problem, request, progress);
    Result result = run.go();
    if (request.horizon) result.reproducible_until = horizon(problem, result.end_time, progress);
    return result;
}

}  // namespace beamcam::sim
