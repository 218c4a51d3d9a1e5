// Draws the mechanism with OpenGL. Each thread keeps one between frames.
#pragma once

#include <memory>
#include <optional>

#include "render/film/mechanism_view.hpp"
#include "render/gl/lit.hpp"

namespace beamcam::render {

class LitMechanism {
  public:
    // `within` contains the lit mechanism at all frames, shadows included; whole pixels.
    void draw(Canvas& canvas, const MechanismShape& shape, const MechanismView& at, const Box& within);
    void draw_solid(const MechanismScene& s, const std::vector<Color>& rim);

  private:
    LitRenderer& renderer(const MechanismView& at, const Box& within);  // creates it on first use

    std::unique_ptr<LitRenderer> renderer_;
    Image image_;
    struct SolidPicture {
        MechanismShape shape;
        Perspective view;
        std::vector<Color> rim;
        bool operator==(const SolidPicture&) const = default;
    };
    std::optional<SolidPicture> solid_;    // the solid view in the image
    std::optional<MechanismShape> shape_;  // the lit shape in the image
    DirtyTiles tiles_;                     // its tiles
};

// The box of the shapes enlarged by their shadows, clipped to `within`, in whole pixels.
Box lit_box(const Box& shapes, const Box& within, double unit);

}  // namespace beamcam::render
