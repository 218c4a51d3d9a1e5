// Draws rounds and strips with light per pixel.
//
// Every shape is a few triangles larger than itself; the fragment shader knows the distance to the shape's edges and
// makes coverage, normal and light of it. Blending is of premultiplied colours, in drawing order: no depth buffer and
// no samples are needed for a mechanism whose parts lie behind each other.
#pragma once

#include "render/gl/lit.hpp"
#include "render/gl/module/opengl.hpp"

namespace beamcam::render {

class LitPainter {
  public:
    LitPainter(int width, int height);  // in the current context
    // Draws the picture within these tiles; null: all of it. Returns the time of reading the pixels [s].
    double draw(const LitScene& scene, const DirtyTiles* where, Image& out);

  private:
    void draw_shapes(const LitScene& scene);
    void draw_round(const LitRound& r, Vec2 shift, float soft, float opacity);
    void draw_strip(const LitStrip& strip, Vec2 shift, float soft, float opacity);

    int width_, height_;
    GLuint round_ = 0, round_shadow_ = 0, strip_ = 0, strip_shadow_ = 0;  // programs
    GLuint no_vertices_ = 0, strip_vertices_ = 0, buffer_ = 0, target_ = 0;
};

}  // namespace beamcam::render
