#include "sim/run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/base/assert.hpp"
#include "sim/base/numerics.hpp"
#include "sim/integrate/integrator.hpp"

namespace beamcam::sim {
namespace {

// The share of the tolerance for the local errors of `auto`: the sum over many impacts stays within ten times rtol.
constexpr double kLocalShare = 1.0 / 3;
// The errors of integrals of a given motion add up.
constexpr double kShareOfSums = 0.03;
constexpr double kLongStep = 1e3;  // [rad] of the fastest vibration: after such a step `progress` is called
// Attempted steps at the first projection: chatter may take some thousands.
constexpr long kFirstProjection = 20000;
// A run stops early if the projected number of steps exceeds kHopeless × the budget. The first projection uses all
// steps so far, later ones those since the last. If these are fewer than kSureProjection, which a brief phase can have,
// the limit grows with the square of the ratio.
constexpr double kSureProjection = 30000, kHopeless = 100;
// The largest number that a scene may have [length, or rad]. How fast a linear model diverges above its critical
// speed is a question that runs answer, so that a deflection that no beam has does not end them.
constexpr double kUnboundedDeflection = 1e30;
constexpr double kPredictedShift = 1e-3;  // of the step: largest correction of an event's time
constexpr int kMaxIdleEvents = 50;        // at one instant: then the run stops

std::unique_ptr<Integrator> make_integrator(const Solver& solver, Method method, System& system) {
    double share = solver.method == Method::automatic ? kLocalShare : 1;
    if (method == Method::cvode_bdf && method != solver.method) share *= kShareOfBdf;
    if (system.is_given()) share *= kShareOfSums;
    const double rtol = share * solver.rtol, atol = share * solver.atol;
    switch (method) {
        case Method::automatic:
            return make_exponential(system, rtol, atol);
        case Method::rk8:
            return make_rk8(system, rtol, atol);
        case Method::cvode_adams:
        case Method::cvode_bdf:
            break;
    }
    return make_sundials(method, system, rtol, atol);
}

}  // namespace

Run::Run(const Problem& problem, const Progress& progress, const RunOptions& options)
    : problem_(problem),
      progress_(progress),
      start_(options.start),
      system_(problem),
      probe_(system_),
      method_(used_method(problem.solver.method, system_)),
      integrator_(make_integrator(problem.solver, method_, system_)),
      touch_search_(probe_, state_, [this](double t) { report(t); }),
      contact_guards_(probe_, state_),
      transitions_(system_, *integrator_, state_),
      kinks_(system_.drive().kinks()),
      end_(options.end),
      step_end_(options.step_ends_there ? options.end : std::numeric_limits<double>::infinity()),
      next_projection_(kFirstProjection) {}

void Run::integrate() {
    for (const Observer* observer : state_.observers) end_ = std::max(end_, observer->end());
    try {
        start();
        while (state_.t < end_ && !observers_are_done()) {
            check_budget();
            check_deflection();
            check_lock();
            process(step());
        }
    } catch (const StepFailure& failure) {
        if (!started_)
            throw SolverError(
                fmt::format("at the start: {}; give another initial.shape or initial.angle", failure.what()), 0, {});
        throw SolverError(explain(failure), state_.t, {});
    }
}

bool Run::observers_are_done() const {
    return !state_.observers.empty() && std::ranges::all_of(state_.observers, &Observer::done);
}

void Run::start() {
    const InitialState initial = start_ ? *start_ : initial_state(system_);
    state_.y = initial.y;
    state_.statistics.fallbacks.left_behind = initial.left_behind;
    state_.statistics.fallbacks.unstable = initial.unstable;
    state_.phase = initial.phase;
    transitions_.enter_phase();
    started_ = true;
    integrator_->stop_at(next_kink());
    transitions_.start(initial.continued ? &*initial.continued : nullptr);
    transitions_.announce_start();
    resume();
}

const Segment& Run::step() {
    const Segment& segment = integrator_->step();
    last_step_ = segment.t1 - segment.t0;
    if (++steps_ % kStepsPerReport == 0 || last_step_ * system_.highest_frequency() > kLongStep) report(segment.t1);
    return segment;
}

// Advances to the first event in the segment, or to its end.
void Run::process(const Segment& segment) {
    const Event event = first_event(segment);
    if (event.kind == EventKind::none) {
        const bool kink = segment.t1 >= next_kink();
        record(segment, segment.t0, segment.t1, kink);
        if (!kink) return;
    } else {
        if (!reach(segment, event)) return;
        transitions_.apply(event);
    }
    pass_kinks();
    resume();
}

Event Run::first_event(const Segment& segment) {
    if (!problem_.cam) return {};
    if (state_.phase.touching) {
        const Event event =
            state_.phase.held ? contact_guards_.first_lift(segment) : contact_guards_.first_event(segment);
        const auto kink = contact_guards_.first_kink(segment);
        return kink && (event.kind == EventKind::none || *kink < event.t) ? Event{EventKind::kink, *kink} : event;
    }
    const auto touch = touch_search_.first_touch(segment);
    return touch ? Event{EventKind::touch, *touch} : Event{};
}

// Advances the state to the event. False if the run ends before it, or if a shorter step was processed instead.
bool Run::reach(const Segment& segment, const Event& event) {
    const double start = segment.t0;
    BEAMCAM_ASSERT(event.t >= start && event.t <= segment.t1);
    if (event.t > start) {
        double at = event.t;
        const Segment& ended = shorten(start, event, at);
        if (ended.t1 < at) {
            process(ended);
            return false;
        }
        // Even if the run ends before the event, so that it remains a prefix of a longer run.
        record(ended, start, ended.t1, true);
        state_.idle_events = 0;
        return ended.t1 <= end_;
    }
    record(segment, start, start, true);
    if (++state_.idle_events > kMaxIdleEvents)
        throw RunStopped(Stop::stuck, "the contact changes its state again and again without time passing");
    return true;
}

// Repeats the step from `start` up to the event. Its end is more accurate than the dense output on which the event was
// found: one Newton step in time corrects the instant `at` of a touch or release.
const Segment& Run::shorten(double start, const Event& event, double& at) {
    const Segment& ended = integrator_->shorten(at);
    if (ended.t1 != at || (event.kind != EventKind::touch && event.kind != EventKind::release)) return ended;
    const ContactState c = probe_.contact(ended, ended.t1);
    const double dt = -c.gap / c.gap_rate;
    if (!std::isfinite(dt) || !(std::fabs(dt) < kPredictedShift * (ended.t1 - start))) return ended;
    at += dt;
    return integrator_->shorten(at);
}

// Shows the segment from `from` to `until`, or to the end of the run. `event`: an event follows there.
void Run::record(const Segment& segment, double from, double until, bool event) {
    const double to = std::min(until, end_);
    const bool goes_on = event && until <= end_;
    for (Observer* observer : state_.observers) {
        if (observer->done()) continue;
        const double end = observer->end();
        observer->step({&segment, from, std::min(to, end), end < to || (end == to && !goes_on)});
    }
    segment.value(to, state_.y.data());
    state_.t = to;
}

// Starts the integrator: at the beginning and after each event.
void Run::resume() {
    for (Observer* observer : state_.observers)
        if (!observer->done()) observer->resume(state_.t, state_.y, state_.phase);
    if (state_.t < end_) integrator_->start(state_.t, state_.y.data());
}

void Run::check_budget() {
    const long tried = integrator_->counters.steps + integrator_->counters.rejected;
    if (tried >= problem_.solver.max_steps) throw RunStopped(Stop::steps_spent, "the budget of steps is spent");
    if (tried < next_projection_) return;
    const auto recent = static_cast<double>(tried - projected_at_step_);
    projected_steps_ = static_cast<double>(tried) + recent * (end_ - state_.t) / (state_.t - projected_at_time_);
    const double uncertainty = std::max(1.0, kSureProjection / recent);
    next_projection_ = 2 * tried;
    projected_at_step_ = tried;
    projected_at_time_ = state_.t;
    if (projected_steps_ > kHopeless * uncertainty * uncertainty * problem_.solver.max_steps)
        throw RunStopped(Stop::too_slow, "the budget of steps is too small");
}

// Stops before the numbers of a diverging solution overflow.
void Run::check_deflection() const {
    const double unit =
        problem_.beam.model == ModelKind::exact ? 1 : problem_.beam.length;  // its coordinates are angles
    for (std::size_t i = 1; i < static_cast<std::size_t>(system_.coordinates()); ++i)
        if (!(std::fabs(state_.y[i]) < kUnboundedDeflection * unit))
            throw StepFailure("the deflection grows without bound");
}

// Stops where friction keeps a rigid beam in a compliant contact that deepens, as it does in an impact (S43): the force
// would grow until the beam has passed the cam. A small force may still be overcome by the load on the beam.
void Run::check_lock() {
    if (!state_.phase.touching || state_.phase.held || steps_ % kStepsPerReport != 0) return;
    if (system_.coordinates() > 1 || is_prescribed(problem_.hub.drive) || system_.friction().none()) return;
    const ContactState c = system_.contact(state_.t, state_.y.data());
    const Compliance response = system_.compliance(state_.t, state_.y.data(), c);
    if (c.force * response.nn > std::fabs(system_.free_gap_acceleration(state_.t, state_.y.data())))
        resolve_impact(response, c.gap_rate, c.slip, system_.friction().kinetic, 0, ImpactLaw::newton);
}

// The next instant at which a step ends: the right-hand side is not smooth, summed-up chatter ends, or the run does.
double Run::next_kink() const {
    const double kink = kinks_.empty() ? step_end_ : std::min(step_end_, kinks_.front());
    return std::min(kink, state_.chatter_end.value_or(kink));
}

// True if t is reached up to rounding.
bool Run::is_reached(double t) const { return t - state_.t <= kRounding * std::fabs(state_.t); }

void Run::pass_kinks() {
    while (!kinks_.empty() && is_reached(kinks_.front())) kinks_.erase(kinks_.begin());
    if (state_.chatter_end && is_reached(*state_.chatter_end)) transitions_.end_chatter();
    integrator_->stop_at(next_kink());
}

void Run::report(double t) const {
    if (progress_ && !progress_(std::min(t, end_))) throw Interrupted();
}

RunStatistics Run::statistics() const {
    RunStatistics all = state_.statistics;
    all.counters = integrator_->counters;
    all.counters.gap_evaluations = system_.gap_evaluations;
    all.method = method_;
    all.fallbacks.coarse = probe_.coarse;
    all.fallbacks.steps = integrator_->fallback_steps;
    all.fallbacks.method = integrator_->fallback;
    return all;
}

std::string Run::explain(const StepFailure& failure) {
    const auto* stopped = dynamic_cast<const RunStopped*>(&failure);
    Stop why = stopped ? stopped->why : Stop::method;
    if (dynamic_cast<const InertiaLost*>(&failure) || system_.inertia_lost()) why = Stop::inertia_lost;
    if (dynamic_cast<const ContactLocked*>(&failure)) why = Stop::locked;
    transitions_.enter_phase();
    return sim::explain({why, failure.what(), state_.t, last_step_, projected_steps_}, system_, state_.y.data());
}

}  // namespace beamcam::sim
