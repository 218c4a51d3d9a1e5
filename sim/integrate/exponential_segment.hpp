// A step of the exponential collocation: nodal values from which every component can be evaluated anywhere inside, by
// the exact oscillation from the node before. `value` is a function of the numbers below and of the problem alone.
// MODEL.md §12.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sim/integrate/integrator.hpp"
#include "sim/integrate/modal_form.hpp"
#include "sim/integrate/vibration_work.hpp"

namespace beamcam::sim {

struct VibrationBounds;

class ExponentialSegment final : public Segment {
  public:
    ExponentialSegment(std::shared_ptr<const ModalForm> modal_form, const DriveLaw& drive_law, int state_size);
    void value(double t, double* y) const override;
    void value_without_vibration_work(double t, double* y) const override;
    double coordinate(double t, std::size_t index, double* y) const override;
    void coordinates(double t, double* y) const override;
    const MotionBounds* bounds() const override;
    // The same as `value` by the dense output, also at t1, of which `end` may be another value.
    void value_inside(double t, double* y) const { evaluate(t, true, y); }
    // The coordinates and their rates alone.
    void motion_inside(double t, double* y) const;
    const TouchSamples* touch() const override { return touching ? &samples : nullptr; }
    // A step of this length; its numbers will change.
    void begin(double length) {
        h = length;
        bristle_rate = Lanes{};
        changed();
    }
    // To be called whenever the numbers change.
    void changed() {
        expanded_ = -1;
        transposed_ = hub_known_ = false;
        bounds_known_ = vibration_works_known_ = false;
    }

    double h = 0;                // of the collocation; t1 may lie before t0 + h
    double theta0 = 0, p0 = 0;   // Θ and ∂T/∂Θ̇ at t0
    std::vector<double> q0, v0;  // q, q̇ at t0
    std::vector<Lanes> q, v, f;  // at the nodes: q, q̇, forcing per mass
    Lanes theta_dot{}, p_dot{};  // Θ̇ and ṗ at the nodes
    double bristle0 = 0;         // z at t0, if the state has it
    Lanes bristle_rate{};        // ż at the nodes
    double ledger0[kLedgerSize] = {};
    Lanes rate[kLedgerSize] = {};  // of the ledger at the nodes, without the work of vibration
    bool ledger_changes = false;   // in this step
    bool touching = false;
    TouchSamples samples;     // if touching
    double boundary0 = 0;     // `drive_boundary` at t0
    std::vector<double> end;  // y at t1

    // Fills the ledger in y, all but the work of vibration. `weights`: of the integral to the instant of y.
    void set_ledger(const Lanes& weights, double* y) const;
    // Adds that at t, from the rest of y.
    void add_vibration_work(double t, double s, double* y) const;
    // The part of the drive's work that has a closed form, at t.
    double drive_boundary(double t, const double* y) const;
    bool has_bristle() const { return controlled_ > 2 * (n_ + 1); }
    // The part of q̇ of a mode that the nodes resolve: all, one of two decays, or none.
    Lanes resolved_rate(std::size_t mode) const;
    // Θ̇ for given coordinates.
    double theta_dot_at(double p, const double* coordinates) const;

  private:
    static constexpr std::size_t kPoints = kNodes + 1;  // the start of the step and its nodes
    struct Hub {
        StepPowers<kNodes + 1> turn, momentum;  // integrals of Θ̇ and ṗ
    };
    const Hub& hub() const;
    double frame_angle(double t) const;  // t != t1
    void transpose() const;
    int last_point(double t, double s) const;
    void expand(int point) const;
    void evaluate(double t, bool vibration_work, double* y) const;
    void oscillate(double t, double* y) const;
    void evolve(std::size_t group, double t, double s, Lanes& x, Lanes& rate) const;
    void evolve_all(double t, double s, double* y) const;
    double structural_loss(std::size_t mode, double s, const double* y) const;
    struct VibrationWorks {  // by mode; none of those that the nodes resolve
        std::vector<std::optional<VibrationWork>> forcing, torque;
    };
    const VibrationWorks& vibration_works() const;
    struct Largest {  // within the step, of a mode
        double force, amplitude, rate;
    };
    void find_largest(std::size_t group) const;
    double largest_rate(std::size_t mode, double amplitude, double force) const;
    double missed_turning(const VibrationBounds& sum) const;
    double hub_acceleration(const VibrationBounds& sum, double fastest) const;
    void bound_points(const VibrationBounds& sum, MotionBounds& b) const;
    double torque_on_vibration(double s, const double* y) const;

    std::shared_ptr<const ModalForm> form_;
    const DriveLaw drive_;
    std::size_t n_, controlled_;
    mutable bool bounds_known_ = false;
    mutable MotionBounds bounds_;
    mutable std::vector<Largest> largest_;  // valid with `bounds_`
    mutable bool vibration_works_known_ = false;
    mutable VibrationWorks vibration_works_;
    mutable bool hub_known_ = false;
    mutable Hub hub_;  // valid with `hub_known_`
    mutable int expanded_ = -1;
    // In lanes over eight modes, by group: q, q̇ and f at the nodes (`transposed_`) and q, q̇ at the start; derivatives
    // of f at the point `expanded_`.
    mutable bool transposed_ = false;
    mutable std::vector<Lanes> lanes_q_, lanes_v_, lanes_f_, taylor_;
};

}  // namespace beamcam::sim
