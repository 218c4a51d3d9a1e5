// A step of the exponential collocation in contact: the nodal forces by Newton's method, such that they obey the law of
// the force, or in sustained impulsive contact its constraint (S45). MODEL.md §12.
#pragma once

#include <cmath>

#include "sim/integrate/friction_step.hpp"
#include "sim/integrate/nodal_step.hpp"

namespace beamcam::sim {

class ContactStep {
  public:
    explicit ContactStep(NodalStep& step);

    // A touch begins, not at an end of the beam.
    void begin_touch(const ContactState& c);
    // The contact at the start of the step.
    void begin();
    // Solves for the nodal forces. Returns the error in units of the tolerance, kNoSolution if Newton's method fails or
    // the contact leaves the range of its expansion.
    double solve(const StepTable& nodal);
    // The contact at one state, in coordinates.
    void evaluate(double t, const double* state, ContactKinematics<double>& touch);
    // The contact is deeper than half of the cam's radius of curvature, beyond its geometry; another method continues.
    bool deep() const;
    ForceAndSlopes force(const ContactKinematics<double>& at) const {
        return law_.at(at.radius).linearized(-at.gap, -at.gap_rate, approach);
    }
    // After an accepted step of sustained contact: puts its end on the constraint.
    void hold_end();
    void fill(TouchSamples& samples) const;
    const FrictionStep& friction() const { return friction_step_; }  // of the step just solved

    ContactKinematics<double> start, end;
    ContactLoad load;
    std::vector<double> row;           // ∂(n·r)/∂q of the modes at the start
    double approach = 1;               // δ̇₋ [m/s]
    double mode_rate_per_impulse = 0;  // of all modes, by an impulse along n [1/kg]

  private:
    // ġ + κg at an instant, and the share of it that is left some time later (S45).
    double off(const ContactKinematics<double>& at) const { return step_.system.off_constraint(at.gap, at.gap_rate); }
    double share_left(double after) const { return std::exp(-step_.system.baumgarte_rate() * after); }
    void place_at_start();
    void guess(const StepTable& table);
    bool improve(const StepTable& table, int corrections);
    double depth_rounding() const;
    double rate_rounding() const;
    double disc_travel() const;  // since t = 0 [m]
    ForceAndSlopes normal_residual(int k) const;
    void place_contact(int corrections);
    void linearize(const StepTable& table);
    void move(double sign);
    // What an error of the force changes in the step, in units of the tolerance.
    double of_force(double error) const {
        return error * std::max(mobility_modes_ / step_.scale_modes, mobility_hub_ / step_.scale_theta_dot);
    }
    double error(double h);

    NodalStep& step_;
    const ModalForm& form_;
    const NormalLaw& law_;
    const FrictionLaw& friction_;
    ContactExpansion expansion_;
    FrictionStep friction_step_;
    std::vector<double> row_t_;  // with friction: ∂(t·r)/∂q of the modes at the start
    bool held_ = false;          // sustained impulsive contact
    struct Held {
        double force = 0;  // [N]
        double off = 0;    // ġ + κg, by which a state is off the constraint (S45) [m/s]
    } held_start_, held_end_;
    Lanes off_at_nodes_{};  // ġ + κg that the nodes are to have
    StepTable projected_;   // of the vibrations, in sustained contact
    double gap_offset_ = 0;
    double force_rounding_ = 0;  // of the force by rounding of the penetration and its rate [N]
    double decays_ = 0;          // decay of a gap's rate or a slip by the contact's forces within the step [–]
    double mobility_modes_ = 0, mobility_hub_ = 0, mobility_contact_ = 0;
    double gap_rate_per_impulse_ = 0;  // [1/kg]
    Frame<Lanes> frame_;
    Lanes cam_angle_{};                            // ψ at the nodes
    Lanes contact_theta_{}, contact_theta_dot_{};  // where the contact was evaluated last
    NodalCompliance compliance_;                   // of the gap to normal forces
    std::vector<double> hq_end_, state_;
    std::vector<Lanes> hq_, coordinate_rows_;
};

}  // namespace beamcam::sim
