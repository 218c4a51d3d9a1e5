// The numbers of a close-up: the penetration or the gap; and whether the faces stick or slide.
#pragma once

#include "render/film/panel.hpp"

namespace beamcam::render {

// Whether stick–slip friction is below its limit μF, so that the faces stick; false without contact or such friction.
bool sticks(const sim::Problem& problem, double force, double friction);

struct CloseUpReadings {
    const FilmContext& context;
    const Motion& motion;
    Box box, plot;       // of the panel, and of its plot [px]
    const Prefix& unit;  // of heights

    // `face`: the height of the beam's face at the contact [px]. A halo of the word hides the line of this face.
    void draw(Canvas& canvas, const sim::Pose& pose, double face) const;
};

inline constexpr const char* kWidestGap = "00.0\u00A0mm";
// Of its plot.
inline Color close_up_background(const Palette& p) { return p.tint(p.grid, 0.35); }

}  // namespace beamcam::render
