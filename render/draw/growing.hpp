// A path that grows with time, on a kept layer: each piece is drawn once, however many frames show it.
//
// Pieces are drawn one by one in their order, so the layer's pixels depend only on how many there are, not on which
// frames were drawn before; going back in time starts anew.
#pragma once

#include <vector>

#include "render/draw/canvas.hpp"
#include "render/draw/geometry.hpp"

namespace beamcam::render {

struct GrowingPath {
    std::vector<double> times;  // increasing [s]
    std::vector<Vec2> points;   // [px of the layer]; NaN breaks the path
};
// Points nearer than `least` pixels to the one before are left out, the last one excepted.
GrowingPath thinned(const std::vector<double>& times, const std::vector<Vec2>& points, double least);

class GrowingLayer {
  public:
    GrowingLayer(int width, int height) : image_(width, height) {}
    // The pieces that end at or before t are drawn. Where the layer changed; all of it after going back in time.
    Box until(double t, const GrowingPath& path, const Fonts& fonts, const Pen& pen);
    const Image& image() const { return image_; }
    Box whole() const { return {0, 0, double(image_.width), double(image_.height)}; }

  private:
    Image image_;
    std::size_t drawn_ = 0;  // points passed
};

}  // namespace beamcam::render
