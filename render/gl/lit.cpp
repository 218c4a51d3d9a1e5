#include "render/gl/lit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <thread>

#include "render/base/error.hpp"
#include "render/base/memory.hpp"
#include "render/base/modules.hpp"
#include "render/base/threads.hpp"
#include "render/gl/gl_environment.hpp"

namespace beamcam::render {
namespace {

// To a context without a display, best first: OSMesa loads faster, newer releases of Mesa have EGL alone.
std::vector<std::string> ways() {
    if (const char* one = std::getenv("BEAMCAM_GL"); one != nullptr && *one != '\0') return {one};
    return {"osmesa", "egl"};
}

// Mesa draws in a thread for each processor, up to 32, compiles in a few more, and waits forever for those that could
// not start.
int threads_of_mesa() { return std::min(static_cast<int>(std::thread::hardware_concurrency()), 32) + 4; }

}  // namespace

std::unique_ptr<LitRenderer> make_lit_renderer(int width, int height) {
    ignored_gl_settings();  // settles the environment before Mesa reads it
    if (!can_start_threads(threads_of_mesa()))
        throw ThreadError(fmt::format("no thread can be started for OpenGL; {}", kThreadRemedy));
    std::string reasons;
    for (const std::string& way : ways()) {
        try {
            const auto* library = static_cast<const LitLibrary*>(load_module(fmt::format("beamcam_{}.so", way)));
            return library->make_renderer(width, height);
        } catch (const GlError& error) {
            if (memory_is_short()) throw std::bad_alloc();  // Mesa does not say so
            reasons += fmt::format("\n{}", error.what());
        } catch (const ModuleError& error) {
            reasons += fmt::format("\n{}", error.what());
        }
    }
    throw GlError(fmt::format(
        "lit and solid views need OpenGL: install the Debian package libosmesa6, or libegl1 where there is none, or "
        "choose the flat view (\"view\": {{\"style\": \"flat\"}}){}",
        reasons));
}

}  // namespace beamcam::render
