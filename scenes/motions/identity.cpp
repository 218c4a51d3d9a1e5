#include "scenes/motions/identity.hpp"

#include <fmt/format.h>
#include <link.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>

#include "output/files/digest.hpp"
#include "render/base/modules.hpp"
#include "render/base/versions.hpp"
#include "render/draw/fonts.hpp"
#include "render/gl/renderer.hpp"
#include "scenes/scene/version.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

constexpr const char* kModules[] = {"beamcam_video.so", "beamcam_netcdf.so", "beamcam_osmesa.so", "beamcam_egl.so"};

// Collects the build id, a digest of the content that the linker stores in every program and library.
int add_build_id(dl_phdr_info* info, std::size_t, void* out) {
    if (std::string_view(info->dlpi_name).find("linux-vdso") != std::string_view::npos) return 0;  // part of the kernel
    for (int i = 0; i < info->dlpi_phnum; ++i) {
        const ElfW(Phdr)& part = info->dlpi_phdr[i];
        if (part.p_type != PT_NOTE) continue;
        // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader gives addresses as numbers
        const char* at = reinterpret_cast<const char*>(info->dlpi_addr + part.p_vaddr);
        const char* end = at + part.p_memsz;
        while (at + sizeof(ElfW(Nhdr)) <= end) {
            ElfW(Nhdr) note;
            std::memcpy(&note, at, sizeof note);
            const char* name = at + sizeof note;
            const char* content = name + (note.n_namesz + 3) / 4 * 4;
            if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 && std::memcmp(name, "GNU", 4) == 0)
                static_cast<std::set<std::string>*>(out)->insert(std::string(content, note.n_descsz));
            at = content + (note.n_descsz + 3) / 4 * 4;
        }
    }
    return 0;
}

// The libraries that the program is linked with. Before main no module is loaded, whatever the command.
const std::set<std::string>& linked_build_ids() {
    static const std::set<std::string> all = [] {
        std::set<std::string> found;
        dl_iterate_phdr(add_build_id, &found);
        return found;
    }();
    return all;
}
[[maybe_unused]] const std::set<std::string>& at_start = linked_build_ids();

// The modules that a command may load, by their files.
std::string digest_of_module(const char* name) {
    std::error_code unknown;
    for (const fs::path& place : render::module_places(fs::read_symlink("/proc/self/exe", unknown), name))
        if (fs::is_regular_file(place, unknown)) return output::sha256_of_file(place);
    return "none";
}

}  // namespace

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

const std::string& program_identity() {
    static const std::string identity = [] {
        output::Sha256 builds;
        for (const std::string& each : linked_build_ids()) builds.update(each);
        for (const char* name : kModules) builds.update(digest_of_module(name));
        if (linked_build_ids().empty()) builds.update(output::sha256_of_file("/proc/self/exe"));
        return fmt::format("beamcam {} {} {}", kVersion, builds.hex(), processor_path());
    }();
    return identity;
}

std::string motion_key(const sim::Problem& problem) {
    Scene scene;
    scene.problem = problem;
    return to_json(scene);
}

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

}  // namespace beamcam::scenes
