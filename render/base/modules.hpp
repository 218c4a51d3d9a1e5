// Loads the program's own modules, beamcam_video.so (FFmpeg) and those of OpenGL (gl/lit.hpp), when they are first
// needed: linking their libraries would cost every start some tens of milliseconds.
//
// A module exports one function, `beamcam_module`, and offers one C++ interface through it. Program and module must
// come from the same headers and compiler; `kModuleInterface`, a digest of both, is compared before anything else.
// They are looked for in the build folder, or where the program is installed; $BEAMCAM_MODULE_DIR alone when it is set.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace beamcam::render {

struct ModuleEntry {
    const char* interface_digest;  // kModuleInterface of its build
    const void* library;           // the interface that the module offers; lives as long as the program
};

// The module cannot be used: every place that was searched, and why.
struct ModuleError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The interface of the module in this file. The module stays loaded. Throws ModuleError; std::bad_alloc.
const void* load_module(const std::string& file);

// Where the module may be, best first. `program` is the program's file; empty where /proc is not mounted.
std::vector<std::filesystem::path> module_places(const std::filesystem::path& program, const std::string& file);

}  // namespace beamcam::render

// The only symbol of a module.
#define BEAMCAM_MODULE(library)                                                                              \
    extern "C" __attribute__((visibility("default"))) const beamcam::render::ModuleEntry* beamcam_module() { \
        static const beamcam::render::ModuleEntry entry = {BEAMCAM_MODULE_INTERFACE, &(library)};            \
        return &entry;                                                                                       \
    }
