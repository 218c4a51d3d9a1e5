#include "output/video_library.hpp"

#include <dlfcn.h>

#include <filesystem>
#include <string>

#include "output/errors.hpp"
#include "output/resources.hpp"

namespace beamcam::output {

void* video_library_symbol(const char* name) {
    std::string reasons;
    for (const auto& place : module_candidates("beamcam_video.so")) {
        std::error_code error;
        if (!std::filesystem::exists(place, error)) {
            reasons += "\n  " + place.string() + ": no such file";
            continue;
        }
        // It stays loaded, because x264 keeps threads and tables.
        void* library = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        if (void* symbol = library != nullptr ? dlsym(library, name) : nullptr) return symbol;
        const char* reason = dlerror();
        reasons += "\n  " + place.string() + ": " + (reason != nullptr ? reason : "cannot be loaded");
    }
    throw MissingCodec(
        "films need the module beamcam_video.so with the FFmpeg libraries; install beamcam and libavcodec again. "
        "Looked at:" +
        reasons);
}

}  // namespace beamcam::output
