// Rings that open and fade where impacts began, and the largest force of those that are too brief for the frames.
#pragma once

#include <optional>
#include <vector>

#include "render/film/mechanism_marks.hpp"

namespace beamcam::render {

class ImpactRings {
  public:
    void find(const MechanismView& at);  // of a motion's frames
    void draw(const MechanismScene& s) const;
    // Of the latest contact that less than two frames show, while its ring is there: its largest force, where it was.
    std::optional<ForceArrow> peak(int frame) const;
    bool play(int frame) const;  // one changes from the frame before to this one

  private:
    struct Ring {
        int frame = 0;              // the first that shows it
        double material_angle = 0;  // on the disc, from its mark [rad]
        ForceArrow peak = {};       // of a brief contact; of others no force
    };
    std::vector<Ring> rings_;
    double frames_ = 1;      // that a ring lasts
    bool labelled_ = false;  // what is a peak is said to be one
};

}  // namespace beamcam::render
