// PNG stills and frames: 8 bits, RGB when every pixel is opaque, otherwise RGBA; sRGB; text as iTXt (UTF-8).
// Fast rather than small: one filter ("up"), and ISA-L where it is installed, else libdeflate at level 2. The same
// picture gives the same bytes on one machine; on every machine it gives the same pixels.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "output/atomic_file.hpp"
#include "render/image.hpp"

namespace beamcam::output {

struct PngOptions {
    std::optional<double> dpi;                    // [1/inch], > 0; absent: the file says nothing about size
    std::map<std::string, std::string> metadata;  // keyword (1–79 characters of ASCII) → text (UTF-8)
};

// The file's bytes. Throws UnsupportedOption for impossible options, std::logic_error for an empty image.
std::string encode_png(const render::Image& image, const PngOptions& options = {});

// Throws IoError as well. Frames of a sequence need not be synced one by one.
void write_png(const std::filesystem::path& file, const render::Image& image, const PngOptions& options = {},
               Durability durability = Durability::synced);

}  // namespace beamcam::output
