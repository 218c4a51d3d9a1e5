// Rings that expand and fade at the places of impacts, and the peak force of impacts that are too short for the frames.
#pragma once

#include <optional>
#include <vector>

#include "render/film/mechanism_marks.hpp"

namespace beamcam::render {

class ImpactRings {
  public:
    void find(const MechanismView& at);  // collects the impacts of the motion
    void draw(const MechanismScene& s) const;
    // Peak force of the latest contact shorter than two frames, as long as its ring is visible.
    std::optional<ForceArrow> peak(int frame) const;
    bool change(int frame) const;  // a ring changes between the previous frame and this one

  private:
    struct Ring {
        int frame = 0;              // the first frame that shows it
        double material_angle = 0;  // on the disc, from its mark [rad]
        ForceArrow peak = {};       // of a short contact; force 0 for others
    };
    std::vector<Ring> rings_;
    double frames_ = 1;      // lifetime of a ring
    bool labelled_ = false;  // peaks are shown, because their label says that they are peaks
};

}  // namespace beamcam::render
