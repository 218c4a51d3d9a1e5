// Draws solid bodies in perspective with soft shadows by a shadow map.
//
// The wall has edges of whole pixels and is behind everything, so it is drawn with one sample per pixel and without
// depths. Bodies have four, and the mean of their samples is blended over the wall. The buffers of samples are cleared
// for each picture, so they end where bodies end. They start at the first pixel of the picture: with another origin
// OpenGL would round some corners to another 1/256 px.
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
    void fit_samples(int width, int height);
    void draw_depths(const SolidScene& scene);
    void draw_wall(const SolidScene& scene);
    void draw_bodies(const SolidScene& scene);
    void blend_bodies(const DirtyTiles& where);
    void use_program(GLuint program, const SolidScene& scene);
    void read(const DirtyTiles& seen, Image& out) const;

    int width_, height_;
    int samples_width_ = 0, samples_height_ = 0;            // of the buffers of samples; they only grow
    GLuint bodies_ = 0, wall_ = 0, depths_ = 0, mean_ = 0;  // programs
    GLuint vertices_ = 0, buffer_ = 0, corners_ = 0;        // of the scene
    GLuint tiles_ = 0, tile_buffer_ = 0;                    // corners of runs of tiles
    GLuint samples_ = 0, sample_depths_ = 0, target_ = 0;   // four samples per pixel
    GLuint picture_ = 0, shadow_target_ = 0;
};

}  // namespace beamcam::render
