// The lit view: shaded metal through OpenGL (core profile, in software), orthographic, seen from the front; and the
// solid view (solid.hpp), in perspective.
//
// Light and shadow come from normals computed per pixel (chamfers, turned faces, brushed lengths); edges are
// antialiased by the distance to the shape, which is smoother than four samples and needs none. The renderer lives in
// modules of its own (gl/module/), one on OSMesa and one on EGL, the first of which that works is loaded when a lit
// picture is drawn, and only then; $BEAMCAM_GL, "osmesa" or "egl", names one. A machine without either gets GlError,
// which names the package and the flat view.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/draw/color.hpp"
#include "render/draw/dirty_tiles.hpp"
#include "render/draw/geometry.hpp"
#include "render/draw/image.hpp"
#include "render/gl/solid.hpp"

namespace beamcam::render {

enum class Finish { turned, plain, dome, dimple };

struct LitRound {
    Vec2 centre;  // [px] of the picture, as all here
    double radius = 0;
    Vec2 hole;  // centre of the bore
    double hole_radius = 0;
    double chamfer = 3;
    Color color;
    Finish finish = Finish::plain;
    bool shadow = true;
};

struct LitStrip {
    std::vector<Vec2> face, back;  // both edges, same count >= 2
    std::vector<Color> colors;
    double chamfer = 5;
};

struct LitScene {
    std::vector<LitRound> behind;  // in this order, then the strip, then `front`
    LitStrip strip;
    std::vector<LitRound> front;
    double unit = 1;
    double shadow = 0.3;  // opacity
};

// What the module provides; one thread at a time.
class LitRenderer {
  public:
    virtual ~LitRenderer() = default;
    // Premultiplied pixels on a transparent ground, of the size given at creation.
    virtual void draw(const LitScene& scene, Image& out) = 0;
    // The same where `out` shows what it drew last, and only these tiles, of a picture of this size, can differ.
    virtual void redraw(const LitScene& scene, const DirtyTiles& where, Image& out) = 0;
    // The same of solid bodies in perspective, four samples a pixel, with soft shadows.
    virtual void draw(const SolidScene& scene, Image& out) = 0;
    virtual std::string name() const = 0;  // the driver's, for fingerprints

    double read_back = 0;  // so far, of lit pictures, once they are drawn [s]
};

// What the modules beamcam_osmesa.so and beamcam_egl.so offer.
class LitLibrary {
  public:
    virtual ~LitLibrary() = default;
    virtual std::unique_ptr<LitRenderer> make_renderer(int width, int height) const = 0;
};

// Throws GlError.
std::unique_ptr<LitRenderer> make_lit_renderer(int width, int height);

}  // namespace beamcam::render
