#include "render/gl/renderer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "render/base/error.hpp"
#include "render/base/modules.hpp"

namespace beamcam::render {
namespace {

// The only software driver with OpenGL 3.3; EGL would prefer a graphics card. It draws in the calling thread: frames
// are drawn side by side anyway, and it would wait forever for threads that cannot start.
constexpr std::pair<const char*, const char*> kChosen[] = {
    {"GALLIUM_DRIVER", "llvmpipe"}, {"LIBGL_ALWAYS_SOFTWARE", "1"}, {"LP_NUM_THREADS", "0"}};

// Of several implementations of EGL, Mesa's: that of a graphics card's maker may be asked first.
constexpr const char* kMesaEgl = "/usr/share/glvnd/egl_vendor.d/50_mesa.json";

bool is_read_by_mesa(std::string_view name) {
    constexpr std::string_view kPrefixes[] = {"MESA_", "GALLIUM_",  "GALLIVM_", "LP_",    "DRAW_", "ST_",
                                              "NIR_",  "SOFTPIPE_", "TGSI_",    "LIBGL_", "ZINK_", "D3D12_"};
    return std::ranges::any_of(kPrefixes, [&](std::string_view prefix) { return name.starts_with(prefix); });
}

std::vector<std::string> choose_driver() {
    std::vector<std::string> found;
    for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
        const std::string_view setting = *entry;
        if (is_read_by_mesa(setting.substr(0, setting.find('=')))) found.emplace_back(setting);
    }
    for (const std::string& setting : found) unsetenv(setting.substr(0, setting.find('=')).c_str());
    for (const auto& [name, value] : kChosen) {
        setenv(name, value, 1);
        std::erase(found, std::string(name) + "=" + value);
    }
    if (std::getenv("__EGL_VENDOR_LIBRARY_DIRS") == nullptr && access(kMesaEgl, R_OK) == 0)
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", kMesaEgl, 0);
    return found;
}

// The modules in order of preference: OSMesa loads faster; newer releases of Mesa have only EGL.
std::vector<std::string> modules() {
    std::vector<std::string> all = {"osmesa", "egl"};
    const char* one = std::getenv("BEAMCAM_GL");
    if (one == nullptr || *one == '\0') return all;
    if (std::ranges::find(all, one) == all.end())
        throw GlError(fmt::format("BEAMCAM_GL=\"{}\" is unknown; it selects {}", one, fmt::join(all, " or ")));
    return {one};
}

}  // namespace

const std::vector<std::string>& ignored_gl_settings() {
    static const std::vector<std::string> ignored = choose_driver();
    return ignored;
}

std::unique_ptr<BodyRenderer> make_body_renderer(int width, int height) {
    ignored_gl_settings();  // sets the environment before Mesa reads it
    std::string reasons;
    for (const std::string& name : modules()) {
        try {
            const void* make = load_module(fmt::format("beamcam_{}.so", name));
            return (*static_cast<const MakeBodyRenderer*>(make))(width, height);
        } catch (const GlError& error) {
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
