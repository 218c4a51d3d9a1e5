// The files of a series of pictures: a PNG file, a directory of PNG files in the order of their numbers, or a sequence
// "fall-####.png".
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beamcam::output {

// Throws IoError if there are no pictures, or if `path` is another kind of file.
std::vector<std::filesystem::path> picture_files(const std::filesystem::path& path);

// The parts of a name such as "fall-####.png" before and after the number.
struct NumberedName {
    explicit NumberedName(std::string_view pattern);
    // The digits of a file of this sequence; nothing for another file.
    std::optional<std::string_view> number_in(std::string_view file) const;

    std::string before, after;
};

}  // namespace beamcam::output
