// One-step interface of every integrator: a step yields a segment that can be evaluated anywhere inside. Steps are
// never shortened for output; only `stop_at` (an instant where the right-hand side is not smooth) and the caller's
// events end a segment early.
#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "sim/base/ode.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// The errors of BDF add up, so where it replaces another method it gets this share of the tolerance.
inline constexpr double kShareOfBdf = 0.03;

class System;

// Bounds of magnitudes within a step that may span many periods of vibration; infinite where there is none.
struct MotionBounds {
    double theta_dot = 0, theta_ddot = 0;  // Θ̇ [rad/s], Θ̈ [rad/s²]
    double deflection_speed = 0;           // ∂v/∂t anywhere on the beam [m/s]
    double deflection_acceleration = 0;    // [m/s²]
    double slope_speed = 0;                // ∂²v/∂x∂t [1/s]
    double curvature = 0;                  // ∂²v/∂x² [1/m]
};

// The contact at the start of a step, at its nodes and at its end, in this order.
struct TouchSamples {
    static constexpr int kCount = 10;
    enum class Ending { open, release, clamp, friction };  // why the step ends where it does
    double t[kCount], gap[kCount], gap_rate[kCount], force[kCount], friction[kCount], x[kCount];
    Ending ending = Ending::open;
    bool friction_over = false;  // the state of the bristle ends at the start of the step
};

class Segment {
  public:
    virtual ~Segment() = default;
    // All components at t in [t0, t1].
    virtual void value(double t, double* y) const = 0;
    // Nothing for steps in which each component is a polynomial of degree `kDegree` at most.
    static constexpr int kDegree = 12;
    virtual std::optional<MotionBounds> bounds() const { return std::nullopt; }
    // Null but for steps that solve for the contact force at nodes. No event of the forces lies inside such a step.
    virtual const TouchSamples* touch() const { return nullptr; }
    double t0 = 0, t1 = 0;
};

// Why no step was accepted; `finite`: its error could be estimated.
inline const char* step_failure_reason(bool finite) {
    return finite ? "no step, however short, keeps to the tolerance"
                  : "the forces grow beyond all numbers, however short the steps";
}

// The work of an integration.
struct Counters {
    long steps = 0;  // accepted
    long rejected = 0;
    long rhs_evaluations = 0;
    long gap_evaluations = 0;

    void operator+=(const Counters& more) {
        steps += more.steps;
        rejected += more.rejected;
        rhs_evaluations += more.rhs_evaluations;
        gap_evaluations += more.gap_evaluations;
    }
};

class Integrator {
  public:
    virtual ~Integrator() = default;
    // Starts at (t, y), or continues there after an event.
    virtual void start(double t, const double* y) = 0;
    // No step goes beyond this instant until the next call.
    void stop_at(double t) { stop_ = t; }
    // The first step after the next `start` is at most this long [s].
    void limit_first_step(double h) { first_limit_ = h; }
    // One accepted step. The segment lives until the next call. Throws StepFailure.
    virtual const Segment& step() = 0;
    // Repeats the last step so that it ends at t1, with the accuracy of a step; before t1 where only a shorter step
    // keeps to the tolerance.
    virtual const Segment& shorten(double t1) = 0;

    Counters counters;
    // Those of the steps that are of another method, to which this one left phases.
    long fallback_steps = 0;
    Method fallback = Method::rk8;

  protected:
    // Applies the limit of the first step, and clears it.
    double limited(double h) {
        const double limit = first_limit_;
        first_limit_ = std::numeric_limits<double>::infinity();
        return limit < h ? limit : h;
    }
    double first_limit_ = std::numeric_limits<double>::infinity();
    double stop_ = std::numeric_limits<double>::infinity();
};

// Reads the phase of the system at every `start`. Only for systems with a ModalForm.
std::unique_ptr<Integrator> make_exponential(System& system, double rtol, double atol);
// The wanted method; but what `auto` means for systems without a ModalForm: `rk8`, or CVODE's BDF where a mode is
// damped beyond the critical. For the integrals of a given motion, `rk8`.
Method used_method(Method wanted, System& system);
std::unique_ptr<Integrator> make_rk8(Ode& ode, double rtol, double atol);
// cvode-adams or cvode-bdf.
std::unique_ptr<Integrator> make_sundials(Method method, Ode& ode, double rtol, double atol);

}  // namespace beamcam::sim
