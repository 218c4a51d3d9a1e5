// What surrounds the panels of a picture: title, parameters, notes, clock, scales and captions.
#pragma once

#include "render/film/layout.hpp"

namespace beamcam::render {

struct PictureFrame {
    Layout out;                                         // without panels
    double margin = 0, top = 0, bottom = 0, right = 0;  // of the space that is left for panels [px]
};

PictureFrame picture_frame(int width, int height, const Shown& shown);

// Wide pictures have charts beside the mechanism.
bool is_wide(int width, int height);

// The box in whole pixels, at least one in each direction.
Box whole(const Box& b);

}  // namespace beamcam::render
