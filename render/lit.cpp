#include "render/lit.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "render/error.hpp"

namespace beamcam::render {
namespace {

namespace fs = std::filesystem;
constexpr const char* kModule = "beamcam_gl.so";
constexpr const char* kRemedy =
    "install the Debian package libosmesa6, or choose the flat view: \"view\": {\"style\": \"flat\"}";

// Beside the program (build tree), above it (test programs), or where it is installed; $BEAMCAM_MODULE_DIR alone
// when that is set.
std::vector<fs::path> places() {
    if (const char* own = std::getenv("BEAMCAM_MODULE_DIR"); own && *own) return {fs::path(own) / kModule};
    std::error_code unknown;
    const fs::path program = fs::read_symlink("/proc/self/exe", unknown).parent_path();
    return {program / kModule, program.parent_path() / kModule, program / BEAMCAM_MODULE_FROM_BIN / kModule};
}

using Maker = LitRenderer* (*)(int, int);

Maker load() {
    std::string tried;
    for (const fs::path& path : places()) {
        std::error_code unreadable;
        tried += (tried.empty() ? "" : ", ") + path.string();
        if (!fs::exists(path, unreadable)) continue;
        void* module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);  // stays loaded: its objects outlive us
        if (!module) {
            const char* reason = dlerror();
            throw GlError(
                fmt::format("the lit renderer cannot be loaded ({}); {}", reason ? reason : path.string(), kRemedy));
        }
        if (auto* maker = reinterpret_cast<Maker>(dlsym(module, "beamcam_make_lit_renderer"))) return maker;
        throw GlError(
            fmt::format("{} is not this program's lit renderer; reinstall beamcam, or {}", path.string(), kRemedy));
    }
    throw GlError(
        fmt::format("the lit renderer was not found (looked for {}); reinstall beamcam, or {}", tried, kRemedy));
}

}  // namespace

std::unique_ptr<LitRenderer> make_lit_renderer(int width, int height) {
    return std::unique_ptr<LitRenderer>(load()(width, height));
}

}  // namespace beamcam::render
