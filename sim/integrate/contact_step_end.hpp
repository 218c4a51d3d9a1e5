// Where a step in contact must end: the gap opens, or the clamp of the force sets in or lets go, at its nodes or
// between them. MODEL.md §12, (S58).
#pragma once

#include "sim/integrate/contact_step.hpp"
#include "sim/integrate/event_search.hpp"

namespace beamcam::sim {

class ContactStepEnd {
  public:
    using Ending = TouchSamples::Ending;
    ContactStepEnd(NodalStep& step, ContactStep& contact)
        : step_(step), contact_(contact), law_(step.system.normal_law()), ripples_(step.n) {}

    // A touch begins, or a step ends on the kink of the clamp.
    void reset_side() { side_ = 1; }
    void accept(Ending ending) { side_ = ending == Ending::clamp ? -start_side_ : start_side_; }
    // The step just solved has the error `error`. Cuts it at its first event, by solving shorter ones; the error of
    // what is left.
    double cut(double error, Ending& ending);
    // How far the end of the step lies from the event: to be carried over without solving again [s].
    double carry = 0;

  private:
    double event_at_nodes(double h, Ending& ending) const;
    double event_between_nodes(Ending ending, Ending& found);
    double solve_to(double end, Ending ending);
    double to_event(double h, Ending ending) const;
    Guard penetration_at(double after);
    Ripple unresolved(double span);
    double factor(double gap_rate) const { return law_.factor(-gap_rate, contact_.approach); }

    NodalStep& step_;
    ContactStep& contact_;
    const NormalLaw& law_;
    StepTable table_;
    double side_ = 1, start_side_ = 1;  // of the kink of the clamp: +1 pushes; where the next step starts, the last did
    std::vector<double> scratch_, ripples_;  // ripples_: of the modes from `ripples_known_` on
    std::size_t ripples_known_ = 0;
};

}  // namespace beamcam::sim
