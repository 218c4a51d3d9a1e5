// PNG stills and frames: 8 bits, RGB when every pixel is opaque, otherwise RGBA; sRGB; text as iTXt (UTF-8).
// The filter is "up". The same picture gives the same bytes.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "output/files/atomic_file.hpp"
#include "render/draw/image.hpp"

namespace beamcam::output {

struct PngOptions {
    std::optional<double> dpi;                    // [1/inch], > 0; absent: the file contains no size
    std::map<std::string, std::string> metadata;  // keyword (1–79 characters of ASCII) → text (UTF-8)
};

// The file's bytes. Throws UnsupportedOption for impossible options, std::logic_error for an empty image.
std::string encode_png(const render::Image& image, const PngOptions& options = {});

// Throws IoError as well.
void write_png(const FileTarget& file, const render::Image& image, const PngOptions& options = {});

}  // namespace beamcam::output
