// The bristle of stick-slip friction in a step of the collocation in contact: its deflection and force at the nodes.
// Its force is linear in the slip while it sticks, and in the normal force while it slides; so it is eliminated from
// the equations of the nodal normal forces. MODEL.md §12.
#pragma once

#include "sim/contact/contact_law.hpp"
#include "sim/integrate/collocation.hpp"
#include "sim/integrate/nodal_compliance.hpp"

namespace beamcam::sim {

class BristleStep {
  public:
    explicit BristleStep(const FrictionLaw& law) : law_(law) {}

    // A step of length h starts in this state with this deflection.
    void begin(FrictionState state, double deflection, double h);
    // `normal`, the response of the gap to normal forces, ← the same with the friction that they cause. `across`: of
    // the gap to friction, and of the slip to normal forces; `along`: of the slip to friction. False: it is singular.
    bool eliminate(const NodalCompliance& across, const NodalCompliance& along, NodalCompliance& normal);
    // Friction of a first guess of the normal force, for a slip that remains as it is at the start.
    Lanes guess(const Lanes& normal, double slip) const;
    // Newton's method: friction changes by ahead + follow(change of the normal force). Here for the present forces and
    // slip; gap, gap_rate ← the changes of the gap and its rate that `ahead` causes.
    Lanes ahead(const Lanes& normal, const Lanes& friction, const Lanes& slip, Lanes& gap, Lanes& gap_rate) const;
    Lanes follow(const Lanes& change) const { return -(by_normal_ * change); }
    // Friction, rate of the bristle and its deflection for these normal forces and slip.
    void settle(const Lanes& normal, const Lanes& slip, Lanes& friction, Lanes& rate);

    FrictionState state() const { return state_; }
    double start() const { return start_; }             // z [m]
    const Lanes& deflection() const { return nodes_; }  // z at the nodes [m], after `settle`

  private:
    Lanes force(const Lanes& normal, const Lanes& slip) const;

    const FrictionLaw& law_;
    FrictionState state_ = FrictionState::stick;
    double start_ = 0, h_ = 0;
    Lanes nodes_{};
    NodalCompliance across_;
    NodalMatrix inverse_, by_normal_;  // (1 + ∂force/∂friction)⁻¹; of it times ∂force/∂normal
};

}  // namespace beamcam::sim
