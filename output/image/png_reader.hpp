// Reads PNG files with up to a thousand texts through libspng. A damaged file is an IoError, never an incomplete
// picture.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "output/files/errors.hpp"
#include "output/image/raster.hpp"

namespace beamcam::output {

// By the first bytes. FFmpeg reads pictures of 16 bits per channel (video_reader.hpp), because digests use its
// rounding.
enum class PngKind { none, up_to_8_bits, of_16_bits };
PngKind png_kind(const std::filesystem::path& file);

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
