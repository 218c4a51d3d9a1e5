// A step of the exponential collocation: the forcing at its nodes, the exact response of the oscillators to it, and the
// hub. Flight and contact share it; contact adds its load. MODEL.md §12.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "sim/integrate/contact_lanes.hpp"
#include "sim/integrate/exponential_segment.hpp"
#include "sim/integrate/inertia_forces.hpp"
#include "sim/integrate/nodal_compliance.hpp"
#include "sim/integrate/step_errors.hpp"

namespace beamcam::sim {

// The contact at the nodes.
struct ContactLoad {
    bool rough = false;         // with friction
    Lanes force{}, friction{};  // N, F_t [N]
    std::vector<Lanes> jn, jt;  // ∂(n·r)/∂q, ∂(t·r)/∂q
    ContactKinematics<Lanes> contact;

    Lanes modal(std::size_t i) const { return rough ? force * jn[i] + friction * jt[i] : force * jn[i]; }
    Lanes torque() const { return force * contact.hub + friction * contact.hub_t; }
};

inline constexpr double kNoSolution = std::numeric_limits<double>::infinity();  // an error beyond any tolerance

struct NodalStep {
    NodalStep(System& of, std::shared_ptr<const ModalForm> modal_form, double relative, double absolute, long& count);

    // The start of a step, from the end of the last.
    void begin(double t);
    // An attempt at a step: the hub at the nodes is as prescribed, or guessed as a rigid pendulum.
    void begin_attempt(const StepTable& table);
    // The free motion of q and q̇ at the nodes.
    void propagate_free(const StepTable& table);
    // Propagates also the part of the forcing that does not depend on q and q̇.
    void propagate_unforced(const StepTable& table);
    void propagate(const StepTable& table);
    void propagate_rates(const StepTable& table);
    // Forcing and hub from the nodal q, and q̇ where the modes are not the coordinates. Returns the largest change in
    // units of the tolerance. `load`: null in flight.
    double update_forcing(const StepTable& table, const ContactLoad* load);
    // Computes coordinates and rates at the nodes where the modes are not the coordinates.
    void place_coordinates();
    const Lanes* deflection() const { return inertia_ ? position_.data() + 1 : segment.q.data(); }
    const Lanes* deflection_rate() const { return inertia_ ? rate_.data() + 1 : segment.v.data(); }
    const Lanes& frame_angle() const { return frame_angle_; }
    const Lanes& frame_rate() const { return inertia_ ? rate_[0] : segment.theta_dot; }
    // ṗ at the nodes → Θ̇, Θ.
    void hub_from_load(double h);
    // next ← the state at the end.
    void arrive(const StepTable& table);
    // Scales of errors: of the modes the whole vibration (q̇, ωq), of the hub its own angle and rate.
    void set_scales(const double* a, const double* b);
    // Error of the forcing without that of the contact, in units of the tolerance; sets the scales.
    double forcing_error(double h, const ContactLoad* load);
    // Ledger and end state of the accepted step.
    void finish(const ContactLoad* load);

    System& system;
    const std::shared_ptr<const ModalForm> form;
    const std::size_t n;
    ExponentialSegment segment;
    std::vector<double> next;
    long& evaluations;  // of the forcing at a node
    double theta_dot0 = 0;
    double scale_modes = 1, scale_theta_dot = 1, scale_theta = 1;
    Lanes time{}, theta{};  // theta: of the rigid turn
    Lanes torque{};         // of drive and spring on the hub
    Lanes sin{}, cos{};     // of the frame

  private:
    Lanes hub_angle() const;
    Lanes hub_rate() const;
    Lanes torque_by_law() const;
    void place_torque();
    void place_spring(const StepTable& table);
    void evaluate_angle();
    void advance_angle(const Lanes& to);
    double set_angle(double h);
    void place_start_forcing();
    double start_error(double h) const;
    double turn_hub(double h, const Lanes& inertia);
    double update_by_arrays(const StepTable& table, const ContactLoad* load);
    double update_by_inertia(const StepTable& table, const ContactLoad* load);
    void smooth_force(std::size_t i, Lanes& f) const;
    void finish_ledger(const ContactLoad* load);
    void drive_power(const ContactLoad* load);
    Lanes drive_power_by_arrays() const;
    Lanes drive_power_by_inertia() const;

    double rtol_, atol_;
    Lanes acceleration_{}, drive_torque_{};
    NodalMatrix spring_matrix_{};  // difference of the spring's torque from its law, by that torque
    std::vector<Lanes> base_q_, base_v_, bq_, gq_;
    std::vector<double> start_;          // of the step, in modes
    std::vector<double> start_forcing_;  // of damped modes in flight: there, ṗ and f in place of the rates
    // These are null and empty where the modes are the coordinates.
    std::unique_ptr<InertiaForces> inertia_;
    std::vector<Lanes> position_, rate_, coordinate_acceleration_, mode_acceleration_, forces_, resistance_;
    Lanes frame_angle_{};  // of sin and cos
};

}  // namespace beamcam::sim
