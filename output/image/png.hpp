// PNG stills and frames: 8 bits, RGB when every pixel is opaque, otherwise RGBA; sRGB; text as iTXt (UTF-8).
// The filter is "up"; there are two compressors. The same picture gives the same bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "output/files/atomic_file.hpp"
#include "render/draw/dirty_tiles.hpp"
#include "render/draw/image.hpp"

namespace beamcam::output {

enum class PngCompression {
    small,  // libdeflate, level 6: for single pictures
    quick,  // literals and runs (run_deflate.hpp), in a tenth of the time, a fifth larger: for sequences of drawings
};

struct PngOptions {
    std::optional<double> dpi;                    // [1/inch], > 0; absent: the file contains no size
    std::map<std::string, std::string> metadata;  // keyword (1–79 characters of ASCII) → text (UTF-8)
    PngCompression compression = PngCompression::small;
};

// The file's bytes. Throws UnsupportedOption for impossible options, std::logic_error for an empty image.
std::string encode_png(const render::Image& image, const PngOptions& options = {});

// Encodes pictures of equal size and options one after the other: only changed pixels are compared with those above
// them. The bytes are those of encode_png.
class PngSequence {
  public:
    explicit PngSequence(PngOptions options);

    // `changed`: tiles that may differ from the previous picture; all tiles of the first. The bytes are valid until the
    // next call. Throws as encode_png.
    const std::string& encode(const render::Image& image, const render::DirtyTiles& changed);

    // The segments of each row in which a pixel may differ from the pixel above it.
    class ChangedSegments {
      public:
        ChangedSegments() = default;
        ChangedSegments(int width, int height);
        void compare(const render::Image& image, const render::DirtyTiles& changed);
        std::span<const std::uint8_t> row(std::size_t y) const;  // 0 or 1 for each segment

      private:
        std::size_t columns_ = 0;
        std::vector<std::uint8_t> segments_;
    };

  private:
    PngOptions options_;
    ChangedSegments segments_;
    std::string file_;
};

// Throws IoError as well.
void write_png(const Target& file, const render::Image& image, const PngOptions& options = {});

}  // namespace beamcam::output
