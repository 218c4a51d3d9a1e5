// The contact at many instants: the shapes are expanded about the foot of the contact, so that an evaluation
// costs as many operations as there are modes (the integral of v′², their square), and shapes are evaluated only when
// the foot leaves the range of the expansion. For nearly straight beams of the models that the collocation integrates;
// otherwise it calls System::contact.
#pragma once

#include <memory>
#include <vector>

#include "sim/integrate/contact_lanes.hpp"

namespace beamcam::sim {

class GapProbe {
  public:
    // The system must outlive the probe.
    explicit GapProbe(System& system);

    // As System::contact has it, to rounding, but for `at_end` and `side`.
    ContactState evaluate(double t, const double* y);

  private:
    bool expanded(double t, const double* y, ContactState& c);

    System& system_;
    std::unique_ptr<ContactExpansion> expansion_;  // null: System::contact is always used
    std::vector<double> hq_;
};

}  // namespace beamcam::sim
