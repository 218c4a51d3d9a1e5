// The OpenGL renderer of solid bodies (core profile, in software), for the lit and the solid view.
//
// It is in two modules (gl/module/), one for OSMesa and one for EGL; the first that works is loaded when the first
// picture of bodies is drawn. $BEAMCAM_GL, "osmesa" or "egl", selects one. If neither works, GlError names the package
// to install and the flat view.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/draw/image.hpp"
#include "render/gl/bodies.hpp"

namespace beamcam::render {

// The interface of the modules. Used by one thread at a time.
class BodyRenderer {
  public:
    virtual ~BodyRenderer() = default;
    // Draws premultiplied pixels on a transparent background, of the size given at creation.
    virtual void draw(const BodyScene& scene, Image& out) = 0;
    virtual std::string name() const = 0;  // of the driver, for fingerprints
};

// Offered by the modules beamcam_osmesa.so and beamcam_egl.so.
using MakeBodyRenderer = std::unique_ptr<BodyRenderer> (*)(int width, int height);

// Throws GlError.
std::unique_ptr<BodyRenderer> make_body_renderer(int width, int height);

// Mesa reads its driver and many switches from environment variables, and several make it crash (GALLIUM_DRIVER=zink,
// DRAW_USE_LLVM=0 …). Sets the environment for llvmpipe with Mesa's defaults, once, and returns the user's settings
// that are ignored, "NAME=value". To be called before threads start, because they may read the environment.
const std::vector<std::string>& ignored_gl_settings();

}  // namespace beamcam::render
