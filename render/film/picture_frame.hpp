// What surrounds the panels of a picture: title, parameters, notes, clock, scales and captions.
#pragma once

#include "render/film/layout.hpp"

namespace beamcam::render {

struct PictureFrame {
    Layout out;                                         // without panels
    double margin = 0, top = 0, bottom = 0, right = 0;  // of the space that is left for panels [px]
    bool wide = true;
};

// `beside`: panels may stand beside the header, whose lines must be short enough.
PictureFrame picture_frame(int width, int height, bool beside, const Shown& shown);

inline constexpr double kPanelColumn = 540;  // width of the column of panels beside the mechanism [design px]
// Whether a picture of this size has room for the column; the most by which the column may grow if the mechanism does
// not need the space [px].
bool has_column(double w, double h, double u);
double widening(double w, double u);

// The box in whole pixels, at least one in each direction.
Box whole(const Box& b);

}  // namespace beamcam::render
