// Reads PNG files with up to a thousand texts through libspng. A damaged file is an IoError, never an incomplete
// picture.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "output/files/errors.hpp"
#include "output/image/raster.hpp"

namespace beamcam::output {

bool is_png(const std::filesystem::path& file);  // by its first bytes

// The pixels as 8-bit RGBA, as FFmpeg's `-pix_fmt rgba` gives them; colour profiles and gamma are left alone.
// Throws IoError if the file is unreadable, damaged, cut off, or larger than kLargestSide.
Raster read_png(const std::filesystem::path& file);

// Size and metadata, without decoding the pixels.
struct PngInfo {
    int width = 0, height = 0;                    // [px]
    std::map<std::string, std::string> metadata;  // keyword → text (UTF-8)
};
PngInfo read_png_info(const std::filesystem::path& file);

}  // namespace beamcam::output
