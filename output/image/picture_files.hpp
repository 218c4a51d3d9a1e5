// The files of a series of pictures: a PNG file, a directory of PNG files in the order of their numbers, or a sequence
// "fall-####.png".
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace beamcam::output {

// Throws IoError if there are no pictures, or if `path` is another kind of file.
std::vector<std::filesystem::path> picture_files(const std::filesystem::path& path);

// "frame-9" before "frame-10": runs of digits are compared as numbers.
bool natural_order(const std::string& a, const std::string& b);

}  // namespace beamcam::output
