// Where the program's own files are: beside it when it runs from a build folder, in the prefix when it
// is installed, wherever the prefix was moved to.
//
// Looked for from the folder of /proc/self/exe, then at the place given at configure time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace beamcam::output {

// Folder of the running program; empty where /proc is not mounted.
std::filesystem::path program_directory();

// The folder that holds the scenes and the JSON Schema people start from. Throws IoError in words.
std::filesystem::path scenes_directory();

// Every place where the loadable module `name` ("beamcam_video.so") may be, best first; it need not exist.
std::vector<std::filesystem::path> module_candidates(const std::string& name);

}  // namespace beamcam::output
