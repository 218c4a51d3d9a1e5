// Draws solid bodies in perspective: four samples per pixel, soft shadows by a shadow map.
#pragma once

#include "render/draw/image.hpp"
#include "render/gl/module/opengl.hpp"

namespace beamcam::render {

class SolidPainter {
  public:
    SolidPainter(int width, int height);  // in the current context
    void draw(const SolidScene& scene, Image& out);

  private:
    void make_shadow_target();
    void draw_depths(const SolidScene& scene);
    void draw_scene(const SolidScene& scene);
    void use_program(GLuint program, const SolidScene& scene);
    void read(const DirtyTiles& seen, Image& out) const;

    int width_, height_;
    GLuint bodies_ = 0, wall_ = 0, depths_ = 0;  // programs
    GLuint vertices_ = 0, buffer_ = 0, corners_ = 0, target_ = 0, resolved_ = 0, shadow_target_ = 0;
};

}  // namespace beamcam::render
