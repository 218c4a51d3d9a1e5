// OpenGL by EGL without a surface (EGL_MESA_platform_surfaceless). ignored_gl_settings() makes Mesa choose software.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include "render/base/error.hpp"
#include "render/gl/module/opengl.hpp"

namespace beamcam::render {
namespace {

GlError failure(const char* what) {
    return GlError(fmt::format("EGL {} (error 0x{:x}); {}", what, eglGetError(), kRemedy));
}

// One for the whole process: displays are never closed while other threads may draw.
EGLDisplay display() {
    static const EGLDisplay kDisplay = [] {
        const EGLDisplay found = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (found == EGL_NO_DISPLAY) throw failure("has no platform without surfaces");
        if (!eglInitialize(found, nullptr, nullptr)) throw failure("cannot be initialized");
        return found;
    }();
    return kDisplay;
}

class EglContext final : public GlContext {
  public:
    EglContext() {
        if (!eglBindAPI(EGL_OPENGL_API)) throw failure("has no OpenGL");
        const EGLint attributes[] = {
            EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
        context_ = eglCreateContext(display(), EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
        if (context_ == EGL_NO_CONTEXT) throw failure("offers no OpenGL 3.3 context");
    }
    ~EglContext() override {
        // A context that is current on this thread would live on.
        if (eglGetCurrentContext() == context_)
            eglMakeCurrent(display(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display(), context_);
    }

    void make_current() override {
        if (!eglBindAPI(EGL_OPENGL_API) || !eglMakeCurrent(display(), EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
            throw failure("cannot use its context");
    }

  private:
    EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<GlContext> make_context() { return std::make_unique<EglContext>(); }

}  // namespace beamcam::render
