// Exponential Gauss collocation: the oscillators of the beam are propagated exactly for a forcing that is the
// interpolation polynomial through eight nodal values, so a step spans many periods of vibration.
// MODEL.md §12. Phases that it does not cover are integrated by Runge–Kutta (rk8.cpp) or BDF.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "sim/base/assert.hpp"
#include "sim/base/numerics.hpp"
#include "sim/integrate/contact_step_end.hpp"
#include "sim/integrate/integrator.hpp"

namespace beamcam::sim {
namespace {

// A step of flight errs by the power 8 of its length, one in contact by 12 where the force has just set in. A level is
// a factor √2 in length: below these errors the next step is one level longer, or two.
constexpr int kFlightOrder = 8, kTouchOrder = 12;
constexpr double kLongerTouch = 0.02, kMuchLongerTouch = 1e-4;
constexpr double kShortestFlight = 4e-16, kShortestTouch = 1e-13;  // of the time: rounding; of the force
constexpr double kShortestTouchEver = 1e-11;                       // [s] no contact is as stiff
constexpr int kMostSweeps = 12;     // in flight: at a contraction of a half a step half as long is cheaper
constexpr int kFlightPatience = 1;  // a damper at the hub answers to the first change of the vibration
// [–] of the period of the fastest mode over 2π: where collocation of a constraint needs shorter steps, rounding rules.
constexpr double kShortestHeld = 1e-5;
constexpr double kStiff = 1;  // damping ratio above which stability limits explicit steps: BDF is used
// [rad] of the fastest vibration in a step of modes that are not the coordinates: where their coupling asks for shorter
// ones, Runge and Kutta's method is as good.
constexpr double kLeastTurns = 0.5;
constexpr long kFirstRetry = 32;  // steps of the other method before the next try, twice as many each time

// Solves for the nodal forcing. Returns the error in units of the tolerance, kNoSolution if the iteration fails.
double solve_flight(NodalStep& step, const StepTable& table) {
    step.begin_attempt(table);
    step.propagate_unforced(table);
    FixedPoint iteration(kLongRounding, kStalled, kFlightPatience);
    auto status = FixedPoint::Status::going;
    for (int sweep = 0; sweep < kMostSweeps && status == FixedPoint::Status::going; ++sweep) {
        step.propagate(table);
        if (!step.form->by_arrays() || step.system.spring()) step.propagate_rates(table);
        step.place_coordinates();
        status = iteration.add(step.update_forcing(table, nullptr));
    }
    if (status != FixedPoint::Status::settled) return kNoSolution;
    step.propagate(table);
    step.propagate_rates(table);
    step.arrive(table);
    return step.forcing_error(table.h, nullptr);
}

class Exponential final : public Integrator {
  public:
    Exponential(System& system, double rtol, double atol)
        : system_(system),
          step_(system, ModalForm::of(system), rtol, atol, counters.rhs_evaluations),
          tables_(step_.form->oscillators),
          rtol_(rtol),
          atol_(atol),
          stiff_(step_.n > 0 && system.damping_ratio() > kStiff) {
        if (!system.has_cam()) return;
        contact_.emplace(step_);
        contact_end_.emplace(step_, *contact_);
    }

    void start(double t, const double* y) override {
        const Phase& phase = system_.phase();
        if (contact_end_ && !(touching_ && t == t_)) contact_end_->reset_side();
        touching_ = phase.touching;
        // A rigid beam in sustained contact follows the cam: no vibration limits the steps of the fallback. At
        // tolerances near rounding, as in the search of orbits, this method would take shorter ones.
        falling_back_ = phase.held && step_.n == 0;
        falling_back_ = falling_back_ || (touching_ && !begin_touch(t, y));
        first_step_ = limited(std::numeric_limits<double>::infinity());
        steps_to_retry_ = kNever;
        retry_after_ = kFirstRetry;
        if (falling_back_) return hand_over(t, y, first_step_);
        t_ = t;
        std::copy_n(y, segment().end.size(), segment().end.begin());
    }

    const Segment& step() override {
        if (!falling_back_) {
            if (own_step()) return segment();
            hand_over(t_, segment().end.data(), first_step_);
            retry_later();
        } else if (steps_to_retry_ == 0) {
            if (retry()) return segment();
            retry_later();
        }
        if (steps_to_retry_ > 0) --steps_to_retry_;
        other_->stop_at(stop_);
        return counted(other_->step());
    }

    const Segment& shorten(double at) override {
        if (falling_back_) return counted(other_->shorten(at));
        ExponentialSegment& s = segment();
        BEAMCAM_ASSERT(at > s.t0);
        if (at == s.t1) return s;
        // The dense output is as accurate as the step, except in contact: there the step is solved again unless the
        // difference is rounding.
        if (!touching_ || std::fabs(at - s.t1) <= 2 * kCarried * s.h) {
            carry_to(at);
            return s;
        }
        scratch_.resize(s.end.size());
        s.value(s.t0, scratch_.data());
        if (solve_up_to(at)) return s;
        hand_over(s.t0, scratch_.data(), at - s.t0);
        return counted(other_->step());
    }

  private:
    ExponentialSegment& segment() { return step_.segment; }

    // One step of this method; false where another one has to take over (the state is then that of the start).
    bool own_step() { return touching_ ? touch_step() : flight(); }
    // Another try of this method from where the other one has arrived, which otherwise goes on from there.
    bool retry() {
        last_->value(last_->t1, segment().end.data());
        t_ = last_->t1;
        falling_back_ = (touching_ && !begin_touch(t_, segment().end.data())) || !own_step();
        return !falling_back_;
    }
    // The other method takes some steps before the next try.
    void retry_later() { steps_to_retry_ = std::exchange(retry_after_, 2 * retry_after_); }

    // The other method continues from (t, y), with a first step of at most `first`.
    void hand_over(double t, const double* y, double first) {
        falling_back_ = true;
        if (!other_)
            other_ = stiff_ ? make_sundials(Method::cvode_bdf, system_, kShareOfBdf * rtol_, kShareOfBdf * atol_)
                            : make_rk8(system_, rtol_, atol_);
        fallback = stiff_ ? Method::cvode_bdf : Method::rk8;
        other_->limit_first_step(first);
        other_->stop_at(stop_);
        other_->start(t, y);
        count();
    }

    const Segment& counted(const Segment& segment) {
        count();
        last_ = &segment;
        return segment;
    }
    void count() {
        fallback_steps += other_->counters.steps;
        counters += std::exchange(other_->counters, {});
    }

    // The longest step of flight from here: on the ladder, or shorter where the first step or the rest of the interval
    // is.
    const StepTable& flight_table(bool& last) {
        const double level = step_length(flight_level_);
        const double h = std::min(level, std::max(first_step_, kRounding * std::fabs(t_)));
        last = t_ + kRestLevel * h >= stop_;
        if (last) return tables_.length(stop_ - t_);
        return h < level ? tables_.length(h) : tables_.level(flight_level_);
    }

    // Where the modes are coupled so strongly that this method has to resolve their vibration, the fallback is cheaper.
    bool too_short(double h) const {
        const ModalForm& form = *step_.form;
        return !form.by_arrays() && h * form.oscillators.back().omega < kLeastTurns;
    }

    // Throws StepFailure where no step, however short, keeps to the tolerance.
    bool flight() {
        ExponentialSegment& s = segment();
        s.touching = false;
        step_.begin(t_);
        for (bool rejected = false;; rejected = true) {
            bool last = false;
            const StepTable& table = flight_table(last);
            const double error = solve_flight(step_, table);
            if (error <= 1) {
                if (tables_.on_ladder(table) && !rejected)
                    flight_level_ = higher_level(flight_level_, error, kLongerFlight, kMuchLongerFlight);
                s.t1 = last ? stop_ : t_ + table.h;
                first_step_ = std::numeric_limits<double>::infinity();
                break;
            }
            if (too_short(table.h)) {
                flight_level_ = kFirstFlightLevel;
                return false;
            }
            ++counters.rejected;
            flight_level_ = lower_level(flight_level_, table.h, error, kFlightOrder, 4);
            if (flight_level_ < kLowestLevel || step_length(flight_level_) < kShortestFlight * std::fabs(t_))
                throw StepFailure(step_failure_reason(std::isfinite(error)));
        }
        ++counters.steps;
        step_.finish(nullptr);
        t_ = s.t1;
        return true;
    }

    bool begin_touch(double t, const double* y) {
        const ContactState c = system_.contact(t, y);
        if (c.at_end) return false;
        contact_->begin_touch(c);
        return true;
    }

    bool touch_step() {
        step_.begin(t_);
        contact_->begin();
        for (bool rejected = false;; rejected = true) {
            const bool last = t_ + kRestLevel * step_length(touch_level_) >= stop_;
            const StepTable& table = last ? tables_.length(stop_ - t_) : tables_.level(touch_level_);
            double error = contact_->solve(table), length = table.h;
            if (std::isfinite(error)) {
                if (contact_->deep()) return false;
                TouchSamples::Ending ending = TouchSamples::Ending::open;
                if (!system_.phase().held) error = contact_end_->cut(error, ending);
                if (error <= 1) {
                    if (ending == TouchSamples::Ending::open && !last && !rejected)
                        touch_level_ = higher_level(touch_level_, error, kLongerTouch, kMuchLongerTouch);
                    accept_touch(ending);
                    return true;
                }
                if (std::isfinite(error)) length = segment().h;
            }
            if (!std::isfinite(error) && too_short(table.h)) {
                touch_level_ = kFirstTouchLevel;
                return false;
            }
            ++counters.rejected;
            touch_level_ = lower_level(touch_level_, length, error, kTouchOrder, 3);
            if (step_length(touch_level_) < shortest_touch()) {
                touch_level_ = kFirstTouchLevel;
                return false;
            }
        }
    }

    // [s] Below it another method takes the contact. A constraint force changes no faster than the modes.
    double shortest_touch() const {
        const double rounding = kShortestTouch * std::fabs(t_) + kShortestTouchEver;
        return system_.phase().held ? std::max(rounding, kShortestHeld / system_.highest_frequency()) : rounding;
    }

    void accept_touch(TouchSamples::Ending ending) {
        ExponentialSegment& s = segment();
        ++counters.steps;
        contact_end_->accept(ending);
        s.touching = true;
        s.t1 = s.t0 + s.h;
        first_step_ = s.h;
        step_.finish(&contact_->load);
        contact_->hold_end();
        s.samples.ending = ending;
        s.samples.friction_over = contact_end_->friction_over();
        t_ = s.t1;
        const double carry = std::exchange(contact_end_->carry, 0.0);
        if (carry != 0) {
            carry_to(t_ + carry);
            contact_->evaluate(t_, s.end.data(), contact_->end);
        }
        contact_->fill(s.samples);
        if (carry != 0 && ending == TouchSamples::Ending::release) {
            constexpr int kLast = TouchSamples::kCount - 1;
            s.samples.gap[kLast] = s.samples.force[kLast] = s.samples.friction[kLast] = 0;
        }
    }

    // Ends the step at `at` by solving it again, if that succeeds.
    bool solve_up_to(double at) {
        if (!std::isfinite(contact_->solve(tables_.length(at - segment().t0)))) return false;
        accept_touch(TouchSamples::Ending::open);
        return true;
    }

    // Ends the step at `at` by the dense output.
    void carry_to(double at) {
        ExponentialSegment& s = segment();
        scratch_.resize(s.end.size());
        s.value_inside(at, scratch_.data());
        s.end = scratch_;
        s.t1 = t_ = at;
    }

    System& system_;
    NodalStep step_;
    StepTables tables_;
    std::optional<ContactStep> contact_;
    std::optional<ContactStepEnd> contact_end_;
    const double rtol_, atol_;
    const bool stiff_;                   // a mode is damped beyond the critical
    std::unique_ptr<Integrator> other_;  // the method that takes over, made when it is first needed
    bool falling_back_ = true, touching_ = false;
    double t_ = 0;
    int flight_level_ = kFirstFlightLevel, touch_level_ = kFirstTouchLevel;
    // [s] Limit of the next step of flight, and in contact of one of the fallback.
    double first_step_ = std::numeric_limits<double>::infinity();
    const Segment* last_ = nullptr;  // of the fallback
    static constexpr long kNever = -1;
    long steps_to_retry_ = kNever;  // of the fallback, before this method is tried again
    long retry_after_ = 0;
    std::vector<double> scratch_;
};

}  // namespace

std::unique_ptr<Integrator> make_exponential(System& system, double rtol, double atol) {
    return std::make_unique<Exponential>(system, rtol, atol);
}

Method used_method(Method wanted, System& system) {
    if (system.is_given()) return Method::rk8;
    if (wanted != Method::automatic || ModalForm::exists(system)) return wanted;
    return system.damping_ratio() > kStiff ? Method::cvode_bdf : Method::rk8;
}

}  // namespace beamcam::sim
