// An off-screen image of which a box is drawn into the picture, clipped.
#pragma once

#include <functional>

#include "render/draw/canvas.hpp"

namespace beamcam::render {

class Offscreen {
  public:
    // Draws off screen and blends the box, whole pixels.
    void put(Canvas& onto, const Box& box, const std::function<void(Canvas&)>& draw);

  private:
    Image image_;  // of the picture's size; the box is cleared before drawing
};

}  // namespace beamcam::render
