// A drawing apart from the picture, of which the picture takes a box: cut off at its edges, faint, or as the mean of
// several.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "render/draw/canvas.hpp"

namespace beamcam::render {

class Offscreen {
  public:
    using Draw = std::function<void(Canvas&)>;

    // Whole pixels of the box; `opacity` 0…1.
    void put(Canvas& onto, const Box& box, const Draw& draw, double opacity = 1);
    // The mean of `count` drawings.
    void put_mean(Canvas& onto, const Box& box, std::size_t count,
                  const std::function<void(Canvas&, std::size_t which)>& draw);

  private:
    void fill(const Canvas& like, const Box& box, const Draw& draw);
    template <class Visit>
    void each_byte(const Box& box, const Visit& visit);

    Image image_;  // of the picture's size, clear within the box before it is drawn
    std::vector<std::uint16_t> sums_;
};

}  // namespace beamcam::render
