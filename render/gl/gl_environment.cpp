#include "render/gl/gl_environment.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace beamcam::render {
namespace {

// The one software driver with OpenGL 3.3; EGL would prefer a graphics card.
constexpr std::pair<const char*, const char*> kChosen[] = {{"GALLIUM_DRIVER", "llvmpipe"},
                                                           {"LIBGL_ALWAYS_SOFTWARE", "1"}};

// The number of threads changes nothing but the speed.
bool is_read_by_mesa(std::string_view name) {
    constexpr std::string_view kPrefixes[] = {"MESA_", "GALLIUM_",  "GALLIVM_", "LP_",    "DRAW_", "ST_",
                                              "NIR_",  "SOFTPIPE_", "TGSI_",    "LIBGL_", "ZINK_", "D3D12_"};
    return name != "LP_NUM_THREADS" &&
           std::ranges::any_of(kPrefixes, [&](std::string_view prefix) { return name.starts_with(prefix); });
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
    return found;
}

}  // namespace

const std::vector<std::string>& ignored_gl_settings() {
    static const std::vector<std::string> ignored = choose_driver();
    return ignored;
}

}  // namespace beamcam::render
