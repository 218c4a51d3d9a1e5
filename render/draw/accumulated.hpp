// A path that accumulates over time on a layer of its own: each piece is drawn once, however many frames show it.
//
// Pieces are drawn one by one in order, so the pixels of the layer depend only on how many are drawn, not on which
// frames were drawn before. Going back in time clears the layer.
#pragma once

#include <vector>

#include "render/draw/canvas.hpp"
#include "render/draw/geometry.hpp"

namespace beamcam::render {

struct TimedPath {
    std::vector<double> times;  // increasing [s]
    std::vector<Vec2> points;   // [px of the layer]; NaN breaks the path
};
// Removes points nearer than `least` pixels to the previous one, except the last point.
TimedPath thinned(const std::vector<double>& times, const std::vector<Vec2>& points, double least);

class AccumulatedLayer {
  public:
    AccumulatedLayer(int width, int height) : image_(width, height), painted_(width, height) {}
    // Draws the pieces that end at or before t.
    void extend_to(double t, const TimedPath& path, const Fonts& fonts, const Pen& pen);
    void draw(Canvas& onto, Vec2 corner) const;  // whole pixels

  private:
    Image image_;
    DirtyTiles painted_;
    std::size_t drawn_ = 0;  // number of points drawn
};

}  // namespace beamcam::render
