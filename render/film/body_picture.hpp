// The mechanism as solid bodies, drawn with OpenGL. Each thread keeps one between frames.
#pragma once

#include <memory>
#include <optional>

#include "render/film/mechanism_view.hpp"
#include "render/gl/renderer.hpp"

namespace beamcam::render {

class BodyPicture {
  public:
    // Blends the bodies in the solid view's perspective or, in the lit view, as they are seen from the front.
    void draw(const MechanismScene& s);

  private:
    std::unique_ptr<BodyRenderer> renderer_;  // created on first use
    int fine_ = 0;                            // its pixels in a pixel of the picture, along a line
    Image image_;
    struct Drawn {
        MechanismShape shape;
        Projection view;
        bool operator==(const Drawn&) const = default;
    };
    std::optional<Drawn> drawn_;  // the picture in the image
    DirtyTiles seen_;             // its tiles
};

}  // namespace beamcam::render
