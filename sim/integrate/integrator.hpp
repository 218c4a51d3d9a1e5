// One-step view of every integrator: a step yields a segment that evaluates itself anywhere inside.
// Nothing here knows of beams. Steps are never shortened for output; only `stop_at` (an instant where
// the right-hand side is not smooth) and the caller's events end a segment early.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "sim/base/lanes.hpp"
#include "sim/base/ode.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// Sorts of segments that can be taken down as numbers and evaluated again (trajectory.hpp).
enum class SegmentKind : int { none = 0, rk8 = 1, taylor = 2, exponential = 3 };

// What a long step promises about everything inside it; all are bounds of magnitudes.
struct MotionBounds {
    double spin = 0, spin_acceleration = 0;  // Θ̇ [rad/s], Θ̈ [rad/s²]
    double deflection_speed = 0;             // ∂v/∂t anywhere on the beam [m/s]
    double deflection_acceleration = 0;      // [m/s²]
    double slope_speed = 0;                  // ∂²v/∂x∂t [1/s]
    double slope = 0, curvature = 0;         // ∂v/∂x, ∂²v/∂x² [1/m]
    double angle_low = 0, angle_high = 0;    // of the hub angle [rad]
    double rate_low = 0, rate_high = 0;      // of its rate [rad/s]
    double ripple = 0, ripple_rate = 0;      // of the hub against the frame [rad], [rad/s]
    double fastest = 0;                      // frequency of the fastest vibration that is no rounding [rad/s]
};

// What a step in contact knows of the contact at its start, at its nodes and at its end, in this order.
struct TouchSamples {
    static constexpr int kCount = 10;
    enum class Ending { open, release, clamp };  // why the step ends where it does
    double t[kCount], gap[kCount], gap_rate[kCount], force[kCount], x[kCount];
    Ending ending = Ending::open;
};

// What a step that propagates modes promises about each of them, and of the hub besides.
struct ModalBounds {
    struct Mode {
        double low = 0, high = 0;                          // of q [m]
        double amplitude = 0, rate = 0, acceleration = 0;  // of |q|, |q̇|, |q̈|
        double q_frequency = 0, rate_frequency = 0;        // |q̈| ≤ q_frequency² amplitude, so for q̇ [rad/s]
    };
    std::vector<Mode> modes;
    std::span<const Lanes> q, rate, force;  // at the Gauss nodes: q, q̇ and q̈ + 2γq̇ + ω²q
    Lanes angle{}, spin{};                  // there: of the frame [rad], [rad/s]
    double h = 0;                           // length of the collocation step [s]
    double power_cam = 0, power_drive = 0;  // of magnitudes [W]
};

class Segment {
  public:
    virtual ~Segment() = default;
    // All components at t in [t0, t1].
    virtual void value(double t, double* y) const = 0;
    // One of the first `coordinates` of them, `y` for scratch: the same bits.
    virtual double coordinate(double t, std::size_t index, double* y) const {
        value(t, y);
        return y[index];
    }
    // Appends the numbers that `value` goes by, besides t0 and t1, to `out`; `none`: they are not at hand.
    virtual SegmentKind numbers([[maybe_unused]] std::vector<double>& out) const { return SegmentKind::none; }
    // Steps that may span many periods of vibration tell how far they can be trusted between looks; null for
    // steps in which each component is a polynomial of at most `kDegree`.
    static constexpr int kDegree = 12;
    virtual const MotionBounds* bounds() const { return nullptr; }
    // The same mode by mode; null where the step does not propagate modes.
    virtual const ModalBounds* modal_bounds() const { return nullptr; }
    // By how much the error of the energy balance may be larger within the step than at its ends [J].
    virtual double balance_error() const { return std::numeric_limits<double>::infinity(); }
    // Steps that solve for the contact force at nodes tell it; null for others. No event of the normal force lies
    // inside such a step.
    virtual const TouchSamples* touch() const { return nullptr; }
    double t0 = 0, t1 = 0;
};

// A segment from its numbers: `value` gives the bits that it gave when it was taken down. Loaded again and again; the
// numbers must outlive their use.
class StoredSegment : public Segment {
  public:
    // Throws std::invalid_argument when there are not as many as there must be.
    virtual void load(double begin, double end, std::span<const double> numbers) = 0;
};
// Throws std::invalid_argument for `none` and for what it does not know.
std::unique_ptr<StoredSegment> make_stored_segment(SegmentKind kind, const Problem& problem);
std::unique_ptr<StoredSegment> make_stored_rk8(int size);
std::unique_ptr<StoredSegment> make_stored_taylor(int size);
std::unique_ptr<StoredSegment> make_stored_exponential(const Problem& problem);

// Why even the shortest step was of no use: its error could be told, or the numbers were no longer finite.
inline const char* vanished(bool finite) {
    return finite ? "no step, however short, keeps to the tolerance"
                  : "the forces grow beyond all numbers, however short the steps";
}

struct IntegratorCounters {
    long steps = 0, rejected = 0, rhs = 0, jacobians = 0;
    // Of a method that leaves phases to another: the steps of that other one, and the contacts whose equations it
    // could not solve itself and handed over.
    long fallback_steps = 0, handed_over = 0;
    Method fallback = Method::rk8;
};

class Integrator {
  public:
    virtual ~Integrator() = default;
    // Start, or go on after an event, from (t, y).
    virtual void start(double t, const double* y) = 0;
    // No step goes beyond this instant until the next call.
    void stop_at(double t) { stop_ = t; }
    // The first step after the next `start` is at most this long [s].
    void limit_first_step(double h) { first_limit_ = h; }
    // One accepted step. The segment lives until the next call. Throws StepFailure.
    virtual const Segment& step() = 0;
    // The last step again, ended at t1 inside it; y at its end is as accurate as a step's. It may end before t1, where
    // only a shorter step keeps to the tolerance.
    virtual const Segment& shorten(double t1) = 0;

    IntegratorCounters counters;

  protected:
    // Takes the limit: it serves one start.
    double limited(double h) {
        const double limit = first_limit_;
        first_limit_ = std::numeric_limits<double>::infinity();
        return limit < h ? limit : h;
    }
    double first_limit_ = std::numeric_limits<double>::infinity();
    double stop_ = std::numeric_limits<double>::infinity();
};

// `method` names one; `automatic` is resolved by the caller.
std::unique_ptr<Integrator> make_rk8(Ode& ode, double rtol, double atol);
// cvode-adams, cvode-bdf or arkode-erk.
std::unique_ptr<Integrator> make_sundials(Method method, Ode& ode, double rtol, double atol);

}  // namespace beamcam::sim
