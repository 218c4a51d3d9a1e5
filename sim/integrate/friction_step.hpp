// Friction in a step of the collocation in contact: its force at the nodes, and the deflection of a bristle there. It
// is linearized in the slip and the normal force, and so eliminated from Newton's equations of the nodal normal forces.
// MODEL.md §12.
#pragma once

#include <algorithm>

#include "sim/contact/contact_law.hpp"
#include "sim/integrate/collocation.hpp"
#include "sim/integrate/nodal_compliance.hpp"

namespace beamcam::sim {

class FrictionStep {
  public:
    explicit FrictionStep(const FrictionLaw& law) : law_(law) {}

    // A step of length h starts in this state with this deflection. The responses of the gap to normal forces;
    // `across`: of the gap to friction, and of the slip to normal forces; `along`: of the slip to friction.
    void begin(FrictionState state, double deflection, double h, const NodalCompliance& gap,
               const NodalCompliance& across, const NodalCompliance& along);
    // Friction of a first guess of the normal force, for a slip that remains as it is at the start.
    Lanes guess(const Lanes& normal, double slip) const;
    // Linearizes friction about these forces and this slip, for Newton's method. False: its equations are singular.
    bool linearize(const Lanes& normal, const Lanes& friction, const Lanes& slip);
    // The response of the gap to normal forces with the friction that they cause.
    const NodalCompliance& gap() const { return gap_; }
    // The change of friction with one of the normal force, and those of the gap and its rate without the latter.
    Lanes change(const Lanes& of_normal) const { return ahead_ - by_normal_ * of_normal; }
    Lanes gap_ahead() const { return across_.value * ahead_; }
    Lanes gap_rate_ahead() const { return across_.rate * ahead_; }
    // Of a slip by Coulomb friction within the step [–].
    double decay() const { return decay_; }
    // Of an error of the impulse of friction: the rest is undone by the slip that it causes.
    double lasting_share() const { return 1 / std::max(1.0, least_decay_); }
    // Of Coulomb friction, per normal force: what the polynomial through the nodes misses at the ends of the step,
    // beyond its last coefficients, up to the next node. A slip that changes its sign there changes it at no node.
    double missed(double start_slip, const Lanes& slip, double end_slip) const;
    // Friction, rate of the bristle and its deflection for these normal forces and slip.
    void settle(const Lanes& normal, const Lanes& slip, Lanes& friction, Lanes& rate);

    FrictionState state() const { return state_; }
    double start() const { return start_; }             // z [m]
    const Lanes& deflection() const { return nodes_; }  // z at the nodes [m], after `settle`

  private:
    Lanes force(const Lanes& normal, const Lanes& slip) const;

    const FrictionLaw& law_;
    FrictionState state_ = FrictionState::stick;
    double start_ = 0, h_ = 0, decay_ = 0, least_decay_ = 0;
    Lanes nodes_{};
    NodalCompliance frictionless_, across_, along_, gap_;
    NodalMatrix by_normal_;  // friction falls by, with the normal force
    Lanes ahead_{};          // change of friction at the same normal force
};

}  // namespace beamcam::sim
