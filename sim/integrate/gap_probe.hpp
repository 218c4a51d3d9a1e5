// The gap in flight at many instants: the shapes are expanded about the foot of the contact, so that a look costs as
// many operations as there are modes (the integral of v′², their square), and shapes are evaluated only when the foot
// has moved on. Beams that ModalForm covers and that are nearly straight; System::contact serves what is left.
#pragma once

#include <memory>
#include <vector>

#include "sim/integrate/contact_lanes.hpp"

namespace beamcam::sim {

class GapProbe {
  public:
    // The system outlives the probe. `apart`: looks follow each other by no order.
    explicit GapProbe(System& system, bool apart = false);

    // Gap, its rate, x and the normal of the contact as System::contact has them, to rounding; nothing else is filled
    // in. `search`: where the foot is, is not known from the look before.
    ContactState evaluate(double t, const double* y, bool search);
    // What comes next does not depend, not even by rounding, on what was asked before.
    void forget();

  private:
    bool expanded(double t, const double* y, bool search, ContactState& c);

    System& system_;
    bool apart_;
    std::unique_ptr<ContactExpansion> expansion_;  // null: all looks are the system's
    std::vector<double> hq_;
    double x_ = -1;
};

}  // namespace beamcam::sim
