// OpenGL by OSMesa, which draws into memory and nothing else. Mesa 25.1 is the last that has it.
#include <fmt/format.h>

#include <cstdint>

#include "render/base/error.hpp"
#include "render/gl/module/opengl.hpp"
// glcorearb.h and gl.h cannot be had together; osmesa.h wants only gl.h's types, which are declared above.
#define __gl_h_  // NOLINT(bugprone-reserved-identifier): gl.h's own guard
#define GLAPIENTRY
#include <GL/osmesa.h>

namespace beamcam::render {
namespace {

class OsmesaContext final : public GlContext {
  public:
    OsmesaContext() {
        const int attributes[] = {OSMESA_FORMAT,
                                  OSMESA_BGRA,
                                  OSMESA_DEPTH_BITS,
                                  0,
                                  OSMESA_STENCIL_BITS,
                                  0,
                                  OSMESA_PROFILE,
                                  OSMESA_CORE_PROFILE,
                                  OSMESA_CONTEXT_MAJOR_VERSION,
                                  3,
                                  OSMESA_CONTEXT_MINOR_VERSION,
                                  3,
                                  0};
        context_ = OSMesaCreateContextAttribs(attributes, nullptr);
        if (!context_) throw GlError(fmt::format("OSMesa offers no OpenGL 3.3 context; {}", kRemedy));
    }
    ~OsmesaContext() override { OSMesaDestroyContext(context_); }

    void make_current() override {
        if (!OSMesaMakeCurrent(context_, &unused_, GL_UNSIGNED_BYTE, 1, 1))
            throw GlError(fmt::format("OSMesa's OpenGL context cannot be used; {}", kRemedy));
    }

  private:
    OSMesaContext context_ = nullptr;
    std::uint32_t unused_ = 0;  // what OSMesa wants to draw into while we draw into our own memory
};

}  // namespace

std::unique_ptr<GlContext> make_context() { return std::make_unique<OsmesaContext>(); }

}  // namespace beamcam::render
