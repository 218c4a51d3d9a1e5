#include "render/base/modules.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <new>
#include <string_view>

// Set by CMake: the digest of the headers that program and modules share, and where modules are installed, relative to
// the program's folder and absolute.
#if !defined(BEAMCAM_MODULE_INTERFACE) || !defined(BEAMCAM_BINDIR_NAME) || !defined(BEAMCAM_MODULES_FROM_BIN) || \
    !defined(BEAMCAM_MODULES_FULL)
#error "render/CMakeLists.txt gives the places of modules"
#endif

namespace beamcam::render {
namespace {

namespace fs = std::filesystem;

// A build folder has the installed layout, with the program at its root and test programs in a subfolder.
bool is_build_folder(const fs::path& folder) {
    std::error_code unreadable;
    return fs::is_regular_file(folder / "CMakeCache.txt", unreadable);
}

// The dynamic loader has several messages for failed allocations.
bool is_short_of_memory(std::string_view reason) {
    for (const std::string_view words : {"annot allocate memory", "failed to map segment", "out of memory"})
        if (reason.find(words) != std::string_view::npos) return true;
    return false;
}

const void* interface_in(const fs::path& file, std::string& reason) {
    void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (module == nullptr) {
        const char* words = dlerror();
        reason = words != nullptr ? words : "cannot be loaded";
        if (is_short_of_memory(reason)) throw std::bad_alloc();
        return nullptr;
    }
    const auto entry = reinterpret_cast<const ModuleEntry* (*)()>(dlsym(module, "beamcam_module"));
    if (entry != nullptr && std::string_view(entry()->interface_digest) == BEAMCAM_MODULE_INTERFACE)
        return entry()->library;
    reason = "belongs to another build of beamcam";
    return nullptr;
}

}  // namespace

std::vector<fs::path> module_places(const fs::path& program, const std::string& file) {
    if (const char* own = std::getenv("BEAMCAM_MODULE_DIR"); own != nullptr && *own != '\0')
        return {fs::path(own) / file};
    std::vector<fs::path> places;
    const fs::path folder = program.parent_path();
    for (const fs::path& build : {folder, folder.parent_path()})
        if (places.empty() && !program.empty() && is_build_folder(build))
            places.push_back(build / BEAMCAM_MODULES_IN_BUILD / file);
    if (places.empty() && folder.filename() == BEAMCAM_BINDIR_NAME)
        places.push_back((folder / BEAMCAM_MODULES_FROM_BIN / file).lexically_normal());
    places.push_back(fs::path(BEAMCAM_MODULES_FULL) / file);
    return places;
}

const void* load_module(const std::string& file) {
    std::error_code unknown;
    const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
    std::string searched;
    for (const fs::path& place : module_places(program, file)) {
        std::error_code unreadable;
        std::string reason = "no such file";
        if (fs::exists(place, unreadable))
            if (const void* found = interface_in(place, reason)) return found;
        searched += fmt::format("\n  {}: {}", place.string(), reason);
    }
    throw ModuleError(
        fmt::format("the module {} cannot be used; install beamcam again, or build it where the libraries of this "
                    "module are installed. Searched:{}",
                    file, searched));
}

}  // namespace beamcam::render
