#include "output/resources.hpp"

#include "output/errors.hpp"

// Set by CMake from GNUInstallDirs: relative to the folder of the program, and absolute.
#if !defined(BEAMCAM_RELATIVE_LIBDIR) || !defined(BEAMCAM_RELATIVE_DATADIR)
#error "output/CMakeLists.txt gives the installed places"
#endif

namespace beamcam::output {

namespace fs = std::filesystem;

namespace {

// A build folder repeats the installed layout with the program at its root (and test programs one below), so
// "../lib/beamcam" is looked up from both the program's folder and a folder that would be its bin/.
std::vector<fs::path> candidates(const char* relative, const char* absolute) {
    std::vector<fs::path> places;
    if (const fs::path directory = program_directory(); !directory.empty()) {
        places.push_back((directory / relative).lexically_normal());
        places.push_back((directory / "bin" / relative).lexically_normal());
    }
    places.emplace_back(absolute);
    return places;
}

}  // namespace

fs::path program_directory() {
    std::error_code error;
    return fs::read_symlink("/proc/self/exe", error).parent_path();
}

fs::path scenes_directory() {
    std::string looked_in;
    for (const fs::path& place : candidates(BEAMCAM_RELATIVE_DATADIR, BEAMCAM_FULL_DATADIR)) {
        std::error_code error;
        if (fs::is_directory(place / "scenes", error)) return place / "scenes";
        looked_in += "\n  " + (place / "scenes").string();
    }
    throw IoError("beamcam's own scenes are not where they should be; install it again. Looked in:" + looked_in);
}

std::vector<fs::path> module_candidates(const std::string& name) {
    std::vector<fs::path> places = candidates(BEAMCAM_RELATIVE_LIBDIR, BEAMCAM_FULL_LIBDIR);
    for (fs::path& place : places) place /= name;
    return places;
}

}  // namespace beamcam::output
