#include "scenes/motions/fingerprint.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <map>

#include "output/files/digest.hpp"
#include "render/base/versions.hpp"
#include "render/draw/fonts.hpp"
#include "render/gl/renderer.hpp"

namespace beamcam::scenes {

static std::string fingerprint_with(render::Typefaces typefaces, std::map<std::string, std::string> parts = {}) {
    for (const auto& [name, version] : render::library_versions()) parts[name] = version;
    // pixman reads it before main, so main.cpp cannot remove it.
    if (const char* disabled = std::getenv("PIXMAN_DISABLE")) parts["PIXMAN_DISABLE"] = disabled;
    for (const render::FontFile& font : render::font_files(typefaces)) {
        if (font.path.empty() && typefaces == render::Typefaces::print) continue;  // the Chinese one may be missing
        parts[fmt::format("font {}", font.name)] = output::sha256_of_file(font.path).substr(0, 12);
    }
    output::Sha256 hash;
    for (const auto& [part, version] : parts) hash.update(fmt::format("{}={}\n", part, version));
    return hash.hex().substr(0, 12);
}

std::string flat_fingerprint() { return fingerprint_with(render::Typefaces::screen); }
std::string figure_fingerprint() { return fingerprint_with(render::Typefaces::print); }

std::string body_fingerprint() {
    return fingerprint_with(render::Typefaces::screen,
                            {{"OpenGL", render::make_body_renderer(16, 16)->name()}, {"processor", processor_path()}});
}

std::string processor_path() {
#if defined(__x86_64__)
    __builtin_cpu_init();
    std::string path;
    if (__builtin_cpu_supports("avx512f")) path += " avx512f";
    if (__builtin_cpu_supports("avx2")) path += " avx2";
    if (__builtin_cpu_supports("fma")) path += " fma";
    return "x86-64" + (path.empty() ? " without avx2 and fma" : path);
#elif defined(__aarch64__)
    return "aarch64";
#else
    return "another processor";
#endif
}

}  // namespace beamcam::scenes
