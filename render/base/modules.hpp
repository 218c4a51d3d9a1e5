// Loads the program's modules, beamcam_video.so (FFmpeg) and those of OpenGL (gl/renderer.hpp), on first use: linking
// their libraries would add tens of milliseconds to every start.
//
// A module exports one function, `beamcam_module`, which returns one C++ interface. Program and module must be built
// from the same headers by the same compiler; a digest of both is compared first. Modules are searched in the build
// folder, or where the program is installed; only in $BEAMCAM_MODULE_DIR if that is set.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace beamcam::render {

struct ModuleEntry {
    const char* interface_digest;  // digest of headers and compiler
    const void* library;           // the interface of the module; valid until the program ends
};

// The module cannot be loaded. The message lists every place that was searched, with the reason.
struct ModuleError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Loads the module in this file and returns its interface. It stays loaded. Throws ModuleError, std::bad_alloc.
const void* load_module(const std::string& file);

// Where to search for the module, in order. `program`: the program's file; empty if /proc is not mounted.
std::vector<std::filesystem::path> module_places(const std::filesystem::path& program, const std::string& file);

}  // namespace beamcam::render

// The only symbol of a module.
#define BEAMCAM_MODULE(library)                                                                              \
    extern "C" __attribute__((visibility("default"))) const beamcam::render::ModuleEntry* beamcam_module() { \
        static const beamcam::render::ModuleEntry entry = {BEAMCAM_MODULE_INTERFACE, &(library)};            \
        return &entry;                                                                                       \
    }
