// How long the state of a bristle lasts in a step in contact: FrictionLaw::margin at its start, nodes and end, and
// between the nodes by the polynomial through them. MODEL.md (S36).
#pragma once

#include <array>

#include "sim/integrate/contact_step.hpp"

namespace beamcam::sim {

class FrictionMargin {
  public:
    // The step has just been solved.
    FrictionMargin(const NodalStep& step, const ContactStep& contact);

    // The state does not last from the start on.
    bool over_at_start() const { return !(at_[0] > deep_) && at_[1] < -deep_; }
    // When the state ends, as a time from the start of the step [s]; kNoSolution if it lasts. `smooth`: so are the
    // forces in the step. `ended`: the step ends with the state, which is not looked for there.
    double end(bool smooth, bool ended) const;
    // From the end of the step to the zero of the margin, by its rate [s].
    double to_zero() const;

  private:
    static constexpr int kCount = kNodes + 2;
    double time(int k) const;

    double h_, deep_;
    std::array<double, kCount> at_;
};

}  // namespace beamcam::sim
