// PNG stills and frames: 8 bits, RGB when every pixel is opaque, otherwise RGBA; sRGB; text as iTXt (UTF-8).
// One filter ("up") and two ways to compress; with either the same picture gives the same bytes.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "output/atomic_file.hpp"
#include "render/image.hpp"

namespace beamcam::output {

enum class PngCompression {
    small,  // libdeflate: for single pictures
    quick,  // literals and runs (run_deflate.hpp), in a tenth of the time and a fifth larger: for sequences of drawings
};

struct PngOptions {
    std::optional<double> dpi;                    // [1/inch], > 0; absent: the file says nothing about size
    std::map<std::string, std::string> metadata;  // keyword (1–79 characters of ASCII) → text (UTF-8)
    PngCompression compression = PngCompression::small;
};

// The file's bytes. Throws UnsupportedOption for impossible options, std::logic_error for an empty image.
std::string encode_png(const render::Image& image, const PngOptions& options = {});

// Throws IoError as well. Frames of a sequence need not be synced one by one.
void write_png(const std::filesystem::path& file, const render::Image& image, const PngOptions& options = {},
               Durability durability = Durability::synced);

}  // namespace beamcam::output
