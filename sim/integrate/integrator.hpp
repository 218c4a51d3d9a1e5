// One-step interface of every integrator: a step yields a segment that can be evaluated anywhere inside. Steps are
// never shortened for output; only `stop_at` (an instant where the right-hand side is not smooth) and the caller's
// events end a segment early.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "sim/base/lanes.hpp"
#include "sim/base/ode.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

class System;

// Kinds of segments that can be stored as numbers and evaluated again, by the search for extrema.
enum class SegmentKind : int { none = 0, rk8 = 1, taylor = 2, exponential = 3 };

// Bounds of magnitudes within a step that may span many periods of vibration.
struct MotionBounds {
    double theta_dot = 0, theta_ddot = 0;  // Θ̇ [rad/s], Θ̈ [rad/s²]
    double deflection = 0;                 // of any point from the straight beam at the angle Θ [m]; may be infinite
    double deflection_speed = 0;           // ∂v/∂t anywhere on the beam [m/s]
    double deflection_acceleration = 0;    // [m/s²]
    double slope_speed = 0;                // ∂²v/∂x∂t [1/s]
    double curvature = 0;                  // ∂²v/∂x² [1/m]
    double angle_low = 0, angle_high = 0;  // of the hub angle [rad]
    double rate_low = 0, rate_high = 0;    // of its rate [rad/s]
    double ripple = 0, ripple_rate = 0;    // of the hub against the frame [rad], [rad/s]
};

// The contact at the start of a step, at its nodes and at its end, in this order.
struct TouchSamples {
    static constexpr int kCount = 10;
    enum class Ending { open, release, clamp, friction };  // why the step ends where it does
    double t[kCount], gap[kCount], gap_rate[kCount], force[kCount], friction[kCount], x[kCount];
    Ending ending = Ending::open;
    bool friction_over = false;  // the state of the bristle ends at the start of the step; not stored
};

// Bounds of each mode, and of the hub, within a step; and their values at its nodes.
struct ModalBounds {
    struct Mode {
        double low = 0, high = 0;                          // of q [m]
        double amplitude = 0, rate = 0, acceleration = 0;  // of |q|, |q̇|, |q̈|
        // |q̈| ≤ q_frequency² amplitude, so for q̇ and q̈ [rad/s]
        double q_frequency = 0, rate_frequency = 0, acceleration_frequency = 0;
        double lag = 0;  // of its vibration behind the natural frequency [rad/s]
        // A free vibration or decay since the start of the step, which no polynomial through the nodes follows: bounds
        // of it and its derivatives there, and its frequency. After the time τ they are at most overshoot·e^(−fading τ)
        // times as large, and no larger.
        struct Swing {
            double value = 0, rate = 0, second = 0, frequency = 0, fading = 0, overshoot = 1;
            double left(double tau) const {
                return fading * tau > 0 ? std::min(1.0, overshoot * std::exp(-fading * tau)) : 1;
            }
        };
        static constexpr int kSwings = 2;
        Swing swings[kSwings];  // the vibration, or both decays
        // From the bounds of q, q̇, q̈ and those of the next two derivatives.
        void set_frequencies(double third, double fourth);
    };
    std::vector<Mode> modes;
    std::span<const Lanes> q, rate, force;  // at the Gauss nodes: q, q̇ and q̈ + 2γq̇ + ω²q
    Lanes angle{}, theta_dot{};             // there: of the frame [rad], [rad/s]
    double h = 0;                           // length of the collocation step [s]
    bool resolved = false;                  // every component is a polynomial, and its power that of the ledger
    double power_cam = 0, power_drive = 0;  // of magnitudes [W]
    double balance_error = 0;  // estimate: of the error of the energy balance within the step, beyond its ends [J]
};

class Segment {
  public:
    virtual ~Segment() = default;
    // All components at t in [t0, t1].
    virtual void value(double t, double* y) const = 0;
    // The same bits of all but the structural loss and the work of the drive, which are undefined: where vibration is
    // damped, they cost the most.
    virtual void value_without_vibration_work(double t, double* y) const { value(t, y); }
    // One of the first `coordinates` of them, `y` for scratch: the same bits.
    virtual double coordinate(double t, std::size_t index, double* y) const {
        value_without_vibration_work(t, y);
        return y[index];
    }
    // All of the coordinates, the first components, and the rates of the beam's: the same bits. Others are undefined.
    virtual void coordinates(double t, double* y) const { value_without_vibration_work(t, y); }
    // Appends the numbers that determine `value`, besides t0 and t1, to `out`; `none`: the segment cannot be stored.
    virtual SegmentKind numbers([[maybe_unused]] std::vector<double>& out) const { return SegmentKind::none; }
    // Null for steps in which each component is a polynomial of degree `kDegree` at most.
    static constexpr int kDegree = 12;
    virtual const MotionBounds* bounds() const { return nullptr; }
    // Null where the step does not propagate modes.
    virtual const ModalBounds* modal_bounds() const { return nullptr; }
    // Null but for steps that solve for the contact force at nodes. No event of the forces lies inside such a step.
    virtual const TouchSamples* touch() const { return nullptr; }
    double t0 = 0, t1 = 0;
};

// A segment restored from its numbers: `value` gives the same bits as when it was stored. One object serves many
// segments, one after the other; the numbers must outlive their use.
class StoredSegment : public Segment {
  public:
    // Throws std::invalid_argument when their count is wrong.
    virtual void load(double begin, double end, std::span<const double> numbers) = 0;
};
std::unique_ptr<StoredSegment> make_stored_rk8(int size);
std::unique_ptr<StoredSegment> make_stored_taylor(int size);  // of CVODE
std::unique_ptr<StoredSegment> make_stored_exponential(const System& system);

// Why no step was accepted; `finite`: its error could be estimated.
inline const char* step_failure_reason(bool finite) {
    return finite ? "no step, however short, keeps to the tolerance"
                  : "the forces grow beyond all numbers, however short the steps";
}

struct IntegratorCounters {
    long steps = 0, rejected = 0, rhs = 0, jacobians = 0;
    // Where one method leaves phases to another: the steps of the other, and the contacts that were handed over because
    // their equations could not be solved.
    long fallback_steps = 0, handed_over = 0;
    Method fallback = Method::rk8;
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

    IntegratorCounters counters;

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

// Reads the phase of the system at every `start`.
std::unique_ptr<Integrator> make_exponential(System& system, double rtol, double atol);
std::unique_ptr<Integrator> make_rk8(Ode& ode, double rtol, double atol);
// cvode-adams or cvode-bdf.
std::unique_ptr<Integrator> make_sundials(Method method, Ode& ode, double rtol, double atol);

}  // namespace beamcam::sim
