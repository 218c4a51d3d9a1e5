// The end of a step in contact: where the gap opens, the clamp of the force begins or ends, or a bristle begins to
// stick or slide, at its nodes or between them. MODEL.md §12, (S58).
#pragma once

#include "sim/integrate/event_search.hpp"
#include "sim/integrate/friction_margin.hpp"

namespace beamcam::sim {

inline constexpr double kCarried = 1e-5;  // of a step, by which its end may be moved without solving again

class ContactStepEnd {
  public:
    using Ending = TouchSamples::Ending;
    ContactStepEnd(NodalStep& step, ContactStep& contact)
        : step_(step),
          contact_(contact),
          law_(step.system.normal_law()),
          friction_(step.system.friction()),
          ripples_(step.n) {}

    // A touch begins, or a step ends on the kink of the clamp.
    void reset_side() { side_ = 1; }
    // The state of a bristle does not last from the start of the step on.
    bool friction_over() const { return friction_.bristle && FrictionMargin(step_, contact_).over_at_start(); }
    void accept(Ending ending) { side_ = ending == Ending::clamp ? -start_side_ : start_side_; }
    // Cuts the step just solved, of error `error`, at its first event by solving shorter ones. Returns the error of the
    // last.
    double cut(double error, Ending& ending);
    // Distance from the end of the step to the event, bridged without solving again [s].
    double carry = 0;

  private:
    double first_event(Ending ending, Ending& found);
    double first_force_event(Ending ending, Ending& found);
    double solve_to(double end, Ending ending);
    double to_event(double h, Ending ending) const;
    Guard penetration_at(double after);
    Ripple unresolved(double span);
    double factor(double gap_rate) const { return law_.factor(-gap_rate, contact_.approach); }

    NodalStep& step_;
    ContactStep& contact_;
    const NormalLaw& law_;
    const FrictionLaw& friction_;
    StepTable table_;
    double side_ = 1, start_side_ = 1;       // of the kink of the clamp at the next start and the last: +1 pushes
    std::vector<double> scratch_, ripples_;  // ripples_: of the modes from `ripples_from_` on
    std::size_t ripples_from_ = 0;
};

}  // namespace beamcam::sim
