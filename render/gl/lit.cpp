#include "render/gl/lit.hpp"

#include <fmt/format.h>

#include <new>

#include "render/base/error.hpp"
#include "render/base/memory.hpp"
#include "render/base/modules.hpp"
#include "render/gl/gl_environment.hpp"

namespace beamcam::render {

std::unique_ptr<LitRenderer> make_lit_renderer(int width, int height) {
    ignored_gl_settings();  // settles the environment before Mesa reads it
    try {
        const auto* library = static_cast<const LitLibrary*>(load_module("beamcam_gl.so"));
        return library->make_renderer(width, height);
    } catch (const GlError&) {
        if (memory_is_short()) throw std::bad_alloc();  // Mesa does not say so
        throw;
    } catch (const ModuleError& error) {
        throw GlError(fmt::format(
            "lit and solid views need OpenGL: install the Debian package libosmesa6, or choose the flat view "
            "(\"view\": {{\"style\": \"flat\"}}); {}",
            error.what()));
    }
}

}  // namespace beamcam::render
