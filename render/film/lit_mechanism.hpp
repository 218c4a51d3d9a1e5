// The mechanism drawn through OpenGL: what a thread keeps of it from one frame to the next.
#pragma once

#include <memory>
#include <optional>

#include "render/film/mechanism_view.hpp"
#include "render/gl/lit.hpp"

namespace beamcam::render {

class LitMechanism {
  public:
    // `within`: what the lit mechanism ever covers, shadows included; whole pixels.
    void draw(Canvas& canvas, const MechanismShape& shape, const MechanismView& at, const Box& within);
    void draw_solid(const MechanismScene& s, const std::vector<Color>& rim);

  private:
    std::unique_ptr<LitRenderer> renderer_;  // made when first needed
    Image image_;
    std::optional<MechanismShape> shape_;  // what the image shows
    DirtyTiles tiles_;                     // where it does
};

// A box with room for shadows around these shapes, in whole pixels, cut to the mechanism's.
Box lit_box(const Box& shapes, const Box& within, double unit);

}  // namespace beamcam::render
