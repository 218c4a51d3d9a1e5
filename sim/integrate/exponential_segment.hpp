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

struct LegendreRange;
struct VibrationBounds;

class ExponentialSegment final : public Segment {
  public:
    ExponentialSegment(std::shared_ptr<const ModalForm> modal_form, const DriveLaw& drive_law, int state_size);
    void value(double t, double* y) const override;
    std::optional<MotionBounds> bounds() const override;
    // The same as `value` by the dense output, also at t1, of which `end` may be another value.
    void value_inside(double t, double* y) const;
    // The coordinates and their rates alone.
    void motion_inside(double t, double* y) const;
    const TouchSamples* touch() const override { return touching ? &samples : nullptr; }
    // The nodal values of Θ̇ and ṗ are those of the step: takes their integrals.
    void integrate_hub();

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

    // After the nodal forcing is that of the step: prepares the work of the vibration that the nodes do not resolve.
    void prepare_vibration_work();
    // The ledger in y at the share s of the step, from the coordinates and rates of the modes in y.
    void put_ledger(double t, double s, double* y) const;
    // The part of the drive's work that has a closed form, at t.
    double drive_boundary(double t, const double* y) const;
    bool has_bristle() const { return controlled_ > 2 * (n_ + 1); }
    // The part of q̇ of a mode that the nodes resolve: all, one of two decays, or none.
    Lanes resolved_rate(std::size_t mode) const;
    // J + qᵀBq for these q; J alone where the modes are not the coordinates.
    double inertia(const double* q) const;

  private:
    std::size_t last_point(double t, double s) const;
    void evaluate(double t, double* y) const;
    void evolve(double t, double s, double* y) const;
    double structural_loss(std::size_t mode, double s, const double* y) const;
    struct Largest {  // within the step, of a mode
        double force, amplitude, rate;
    };
    Largest largest_of(std::size_t mode) const;
    double largest_rate(std::size_t mode, double amplitude, double force) const;
    double largest_turning(const LegendreRange& nodal, const VibrationBounds& sum) const;
    double hub_acceleration(const VibrationBounds& sum, double fastest) const;
    void bound_points(const VibrationBounds& sum, MotionBounds& b) const;
    double torque_on_vibration(double s, const double* y) const;

    std::shared_ptr<const ModalForm> form_;
    const DriveLaw drive_;
    std::size_t n_, controlled_;
    StepPowers<kNodes + 1> turn_, momentum_;  // integrals of Θ̇ and ṗ
    // ∫fq̇ and ∫τq̇ of each mode that the nodes do not resolve.
    std::vector<std::optional<VibrationWork>> forcing_work_, torque_work_;
};

}  // namespace beamcam::sim
