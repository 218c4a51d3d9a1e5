// Rings that expand and fade at the places of impacts.
#pragma once

#include <vector>

#include "render/film/mechanism_view.hpp"

namespace beamcam::render {

class ImpactRings {
  public:
    explicit ImpactRings(const MechanismView& at);  // collects the impacts of the motion
    void draw(const MechanismScene& s) const;

  private:
    struct Ring {
        int frame = 0;  // the first frame that shows it
        Vec2 place;     // of the contact then [m]
    };
    std::vector<Ring> rings_;
};

}  // namespace beamcam::render
