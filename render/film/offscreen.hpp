// An off-screen image: draws a box of it into the picture, clipped, with opacity, or as the mean of several drawings.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "render/draw/canvas.hpp"

namespace beamcam::render {

class Offscreen {
  public:
    using Draw = std::function<void(Canvas&)>;

    // Draws off screen and blends the box, whole pixels; `opacity` 0…1.
    void put(Canvas& onto, const Box& box, const Draw& draw, double opacity = 1);
    // Blends the mean of `count` drawings.
    void put_mean(Canvas& onto, const Box& box, std::size_t count,
                  const std::function<void(Canvas&, std::size_t which)>& draw);

  private:
    void fill(const Canvas& like, const Box& box, const Draw& draw);
    template <class Visit>
    void each_byte(const Box& box, const Visit& visit);

    Image image_;  // of the picture's size; the box is cleared before drawing
    std::vector<std::uint16_t> sums_;
};

}  // namespace beamcam::render
