// A step of the exponential collocation: nodal values from which every component can be evaluated anywhere inside, by
// the exact oscillation from the nearest node. The numbers below are all there is to it: `value` is a function of
// them (and of the problem) alone. MODEL.md §12.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim/integrate/integrator.hpp"
#include "sim/integrate/modal_form.hpp"

namespace beamcam::sim {

struct VibrationBounds;

class ExponentialSegment final : public Segment {
  public:
    ExponentialSegment(std::shared_ptr<const ModalForm> modal_form, const DriveLaw& drive_law, int state_size);
    void value(double t, double* y) const override;
    double coordinate(double t, std::size_t index, double* y) const override;
    const MotionBounds* bounds() const override;
    const ModalBounds* modal_bounds() const override;
    double balance_error() const override;
    const TouchSamples* touch() const override { return touching ? &samples : nullptr; }
    // Must be called when the numbers have changed.
    void changed() {
        expanded_ = -1;
        turned_known_ = false;
        bounds_known_ = modal_bounds_known_ = false;
    }

    SegmentKind numbers(std::vector<double>& out) const override;
    void load(double begin, double end_time, std::span<const double> numbers);

    double h = 0;                // of the collocation; t1 may lie before t0 + h
    double theta0 = 0, p0 = 0;   // Θ and ∂T/∂Θ̇ at t0
    std::vector<double> q0, v0;  // q, q̇ at t0
    std::vector<Lanes> q, v, f;  // at the nodes: q, q̇, forcing per mass
    Lanes spin{}, push{};        // Θ̇ and ṗ at the nodes
    double ledger0[kLedgerSize] = {};
    Lanes rate[kLedgerSize] = {};  // of the ledger at the nodes, but for what `ledger_at` adds
    bool ledger_changes = false;   // anything of the ledger changes in this step
    bool touching = false;
    TouchSamples samples;     // if touching
    double boundary0 = 0;     // `drive_boundary` at t0
    std::vector<double> end;  // y at t1

    // Adds to the ledger in y what this step did up to t; the rest of y must be there.
    void ledger_at(double t, double s, const Lanes& weights, double* y) const;
    // What the power of the drive integrates to in closed form, at t.
    double drive_boundary(double t, const double* y) const;
    bool resolved(std::size_t mode) const;
    // q̇ of a mode at the nodes, as far as they resolve it: one of two decays, perhaps.
    Lanes resolved_rate(std::size_t mode) const;
    // Θ̇ for given coordinates.
    double spin_at(double p, const double* coordinates) const;

  private:
    // Calls visit(std::span<double>) on all numbers that `value`, `bounds` and `touch` go by, besides t0 and t1.
    template <class Visit>
    void each_number(Visit&& visit);
    void turn() const;
    void expand(int point) const;
    double expand_before(double s) const;
    void evolve(std::size_t group, double tau, Lanes& x, Lanes& rate) const;
    double structural_loss(std::size_t mode, double s, const double* y) const;
    double work_on(std::size_t mode, const double* g, double s, const double* y) const;
    double work_on_vibration(std::size_t mode, const double* g, double s, const double* y) const;
    double work_on_decay(std::size_t mode, bool fast, const double* g, double s, const double* y) const;
    double largest_amplitude(std::size_t mode, double force) const;
    double largest_rate(std::size_t mode, double amplitude, double force) const;
    double hub_acceleration(const VibrationBounds& sum, double fastest_spin) const;
    void bound_points(const VibrationBounds& sum, MotionBounds& b) const;
    // `legendre`: coefficients of the forcing of its group.
    ModalBounds::Mode mode_bounds(std::size_t mode, const Lanes* legendre) const;
    double torque_on_vibration(double s, const double* y) const;

    std::shared_ptr<const ModalForm> form_;
    const DriveLaw& drive_;
    std::size_t n_, controlled_;
    mutable bool bounds_known_ = false;
    mutable MotionBounds bounds_;
    struct Largest {  // within the step, of a mode
        double force, amplitude, rate;
    };
    mutable std::vector<Largest> largest_;  // known with `bounds_`
    mutable bool modal_bounds_known_ = false;
    mutable ModalBounds modal_bounds_;
    mutable int expanded_ = -1;
    // In lanes over eight modes, by group: f at the nodes; derivatives of f, and q and q̇, at the point `expanded_`.
    mutable bool turned_known_ = false;
    mutable std::vector<Lanes> turned_, taylor_, begin_q_, begin_v_;
};

}  // namespace beamcam::sim
