// Reads any PNG, of beamcam or not, through libpng. Every damage is an IoError in words, never a picture with holes.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "output/files/errors.hpp"
#include "output/image/raster.hpp"

namespace beamcam::output {

// By the first bytes. Pictures of 16 bits a channel are left to FFmpeg (video_reader.hpp), whose rounding to 8 bits the
// digests follow.
enum class PngKind { none, up_to_8_bits, of_16_bits };
PngKind png_kind(const std::filesystem::path& file);

// The pixels as 8-bit RGBA, as FFmpeg's `-pix_fmt rgba` gives them; colour profiles and gamma are left alone.
// Throws IoError: unreadable, damaged, cut off, larger than kLargestSide.
Raster read_png(const std::filesystem::path& file);

// What stands before the pixels; those are not decoded.
struct PngInfo {
    int width = 0, height = 0;                    // [px]
    std::map<std::string, std::string> metadata;  // keyword → text (UTF-8)
};
PngInfo read_png_info(const std::filesystem::path& file);

}  // namespace beamcam::output
