// Rings that expand and fade at the places of impacts, and the peak force of impacts that are too short for the frames.
#pragma once

#include <optional>
#include <vector>

#include "render/film/mechanism_marks.hpp"

namespace beamcam::render {

// Of the peaks that ImpactRings::peak() holds in this panel; 0 if there is none [N].
double largest_held_peak(const FilmContext& context, const PanelSlot& slot);

class ImpactRings {
  public:
    void find(const MechanismView& at);  // collects the impacts of the motion
    void draw(const MechanismScene& s) const;
    // Peak force of a collision, as long as the ring of its latest contact is visible and that is shorter than two
    // frames; at the disc of the frame's pose, in the direction of the force.
    std::optional<ForceArrow> peak(int frame, const sim::Pose& pose) const;
    bool change(int frame) const;  // a ring changes between the previous frame and this one

  private:
    struct Ring {
        int frame = 0;              // the first frame that shows it
        double material_angle = 0;  // on the disc, from its mark [rad]
        ForceArrow peak = {};
        bool brief = false;  // the contact is shorter than two frames
        int collision = 0;
    };
    std::vector<Ring> rings_;
    double radius_ = 0;      // of the disc [m]
    double frames_ = 1;      // lifetime of a ring
    bool labelled_ = false;  // peaks are shown, because their label says that they are peaks
};

}  // namespace beamcam::render
