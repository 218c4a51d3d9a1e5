// The gap in flight at many instants: the shapes are expanded about the foot of the contact, so that an evaluation
// costs as many operations as there are modes (the integral of v′², their square), and shapes are evaluated only when
// the foot leaves the range of the expansion. For nearly straight beams; otherwise it calls System::contact.
#pragma once

#include <memory>
#include <vector>

#include "sim/integrate/contact_lanes.hpp"

namespace beamcam::sim {

class GapProbe {
  public:
    // The system must outlive the probe. `apart`: consecutive instants are not close to each other.
    explicit GapProbe(System& system, bool apart = false);

    // Gap, its rate, slip, x and the normal of the contact as System::contact has them, to rounding; nothing else is
    // filled in. `search`: the foot is not near that of the last evaluation. In contact the foot is
    // followed, in flight a strongly bent beam is searched along its length.
    ContactState evaluate(double t, const double* y, bool search);
    // Later results do not depend, not even by rounding, on earlier evaluations.
    void forget();

  private:
    bool expanded(double t, const double* y, bool search, ContactState& c);

    System& system_;
    bool apart_;
    std::unique_ptr<ContactExpansion> expansion_;  // null: System::contact is always used
    std::vector<double> hq_;
    double x_ = -1;
};

}  // namespace beamcam::sim
