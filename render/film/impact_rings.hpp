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
    // frames; at the instant of the touch it is still to come. It acts on the beam: its arrow stays at the place of the
    // beam that was struck, and turns with it.
    std::optional<ForceArrow> peak(int frame, const DrawnBeam& beam) const;

  private:
    struct Ring {
        int frame = 0;              // the first frame that shows it
        int struck = 0;             // the first one after the instant of the touch
        double material_angle = 0;  // on the disc, from its mark [rad]
        double place = 0;           // on the beam, relative to its length
        Vec2 direction;             // of the force, along the beam and to its left
        double peak = 0;            // [N]
        bool brief = false;         // the contact is shorter than two frames
        int collision = 0;
    };
    double age(const Ring& ring, int frame) const;  // in lifetimes; a freeze stops it

    const FilmContext* context_ = nullptr;  // of the rings found
    std::vector<Ring> rings_;
    bool labelled_ = false;  // peaks are shown, because their label says that they are peaks
};

}  // namespace beamcam::render
