// The OpenGL renderer (core profile, in software): the lit view, orthographic from the front, and the solid view
// (solid.hpp), in perspective.
//
// The lit view computes normals per pixel (chamfers, turned faces, brushed metal) and antialiases edges by their
// distance, which is smoother than four samples. The renderer is in two modules (gl/module/), one for OSMesa and one
// for EGL; the first that works is loaded when the first lit or solid picture is drawn. $BEAMCAM_GL, "osmesa" or "egl",
// selects one. If neither works, GlError names the package to install and the flat view.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/draw/color.hpp"
#include "render/draw/dirty_tiles.hpp"
#include "render/draw/geometry.hpp"
#include "render/draw/image.hpp"
#include "render/gl/solid.hpp"

namespace beamcam::render {

enum class Finish { turned, plain, dome, dimple };  // the shaders know them by number

struct LitRound {
    Vec2 centre;  // [px], as all lengths here
    double radius = 0;
    Vec2 hole;  // centre of the bore
    double hole_radius = 0;
    double chamfer = 3;
    Color color;
    Finish finish = Finish::plain;
    bool shadow = true;
};

struct LitStrip {
    std::vector<Vec2> face, back;  // both edges, of the same size >= 2
    std::vector<Color> colors;
    double chamfer = 5;
    bool closed = false;  // the first station follows the last one; only the face has an edge, others are covered
};

struct LitScene {
    std::optional<LitStrip> cam;   // from its outline to its axis, if it is no disc; drawn first
    std::vector<LitRound> behind;  // then the strip, then `front`
    LitStrip strip;
    std::vector<LitRound> front;
    double unit = 1;
    double shadow = 0.3;  // opacity
};

// The interface of the modules. Used by one thread at a time.
class LitRenderer {
  public:
    virtual ~LitRenderer() = default;
    // Draws premultiplied pixels on a transparent background, of the size given at creation. `where` is null, or `out`
    // contains the last picture, and only these tiles are drawn.
    virtual void draw(const LitScene& scene, const DirtyTiles* where, Image& out) = 0;
    // Draws solid bodies in perspective, four samples per pixel, with soft shadows.
    virtual void draw(const SolidScene& scene, Image& out) = 0;
    virtual std::string name() const = 0;  // of the driver, for fingerprints

    double read_back = 0;  // total time of reading pixels of lit pictures [s]
};

// Offered by the modules beamcam_osmesa.so and beamcam_egl.so.
class LitLibrary {
  public:
    virtual ~LitLibrary() = default;
    virtual std::unique_ptr<LitRenderer> make_renderer(int width, int height) const = 0;
};

// Throws GlError.
std::unique_ptr<LitRenderer> make_lit_renderer(int width, int height);

// Mesa reads its driver and many switches from environment variables, and several make it crash (GALLIUM_DRIVER=zink,
// DRAW_USE_LLVM=0 …). Sets the environment for llvmpipe with Mesa's defaults, once, and returns the user's settings
// that are ignored, "NAME=value". To be called before threads start, because they may read the environment.
const std::vector<std::string>& ignored_gl_settings();

}  // namespace beamcam::render
