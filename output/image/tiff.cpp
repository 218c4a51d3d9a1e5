#include "output/image/tiff.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include "output/files/errors.hpp"
#include "output/files/inflate.hpp"
#include "output/files/numbers.hpp"

namespace beamcam::output {
namespace {

constexpr int kTiffLevel = 9;  // of compression

// Each byte minus that of the pixel at the left (predictor 2), which compresses better.
std::string rows_of(const render::Image& image) {
    std::string out;
    out.reserve(image.pixels.size() * 3);
    for (int y = 0; y < image.height; ++y) {
        std::uint32_t before = 0;
        for (int x = 0; x < image.width; ++x) {
            const std::uint32_t pixel = image.pixels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
            for (const int shift : {16, 8, 0}) out += static_cast<char>((pixel >> shift) - (before >> shift));
            before = pixel;
        }
    }
    return out;
}

enum TagType { ascii = 2, short_number = 3, long_number = 4, ratio = 5 };

struct TagEntry {
    int tag;
    TagType type;
    std::uint32_t count;
    std::string bytes;
};

TagEntry tag_number(int tag, TagType type, std::uint64_t value) {
    TagEntry entry{tag, type, 1, {}};
    append_bytes(entry.bytes, value, 4);
    return entry;
}

TagEntry tag_text(int tag, const std::string& value) {
    return {tag, ascii, static_cast<std::uint32_t>(value.size() + 1), value + std::string(1, '\0')};
}

// The directory at this place of the file; values longer than four bytes follow it.
std::string tag_directory(const std::vector<TagEntry>& entries, std::size_t at) {
    std::string out, behind;
    append_bytes(out, entries.size(), 2);
    const std::size_t end = at + 2 + 12 * entries.size() + 4;
    for (const TagEntry& e : entries) {
        append_bytes(out, static_cast<std::uint64_t>(e.tag), 2);
        append_bytes(out, e.type, 2);
        append_bytes(out, e.count, 4);
        std::string value = e.bytes;
        if (value.size() > 4) {
            append_bytes(out, end + behind.size(), 4);
            behind += value + (value.size() % 2 ? std::string(1, '\0') : "");
        } else {
            value.resize(4, '\0');
            out += value;
        }
    }
    append_bytes(out, 0, 4);
    return out + behind;
}

}  // namespace

std::string encode_tiff(const render::Image& image, const TiffOptions& options) {
    const std::string rows = rows_of(image);
    if (rows.size() > 0xf0000000) throw UnsupportedOption("a TIFF file cannot exceed 4 GiB; lower the dpi");
    std::string out("II*\0", 4);
    const std::string strip = zlib_compressed(rows, kTiffLevel);
    const std::size_t at = 8 + strip.size() + strip.size() % 2;
    append_bytes(out, at, 4);
    out += strip + (strip.size() % 2 ? std::string(1, '\0') : "");

    std::string bits, resolution;
    for (int i = 0; i < 3; ++i) append_bytes(bits, 8, 2);
    constexpr double kUnit = 1000;  // of the resolution's fraction
    append_bytes(resolution, static_cast<std::uint64_t>(std::llround(options.dpi * kUnit)), 4);
    append_bytes(resolution, static_cast<std::uint64_t>(kUnit), 4);
    const auto width = static_cast<std::uint64_t>(image.width), height = static_cast<std::uint64_t>(image.height);
    std::vector<TagEntry> entries = {tag_number(256, long_number, width),
                                     tag_number(257, long_number, height),
                                     {258, short_number, 3, bits},
                                     tag_number(259, short_number, 8),   // compression: deflate
                                     tag_number(262, short_number, 2)};  // RGB
    if (!options.description.empty()) entries.push_back(tag_text(270, options.description));
    entries.push_back(tag_number(273, long_number, 8));  // where the strip begins
    entries.push_back(tag_number(277, short_number, 3));
    entries.push_back(tag_number(278, long_number, height));
    entries.push_back(tag_number(279, long_number, strip.size()));
    entries.push_back({282, ratio, 1, resolution});
    entries.push_back({283, ratio, 1, resolution});
    entries.push_back(tag_number(296, short_number, 2));  // inches
    if (!options.software.empty()) entries.push_back(tag_text(305, options.software));
    entries.push_back(tag_number(317, short_number, 2));  // predictor
    return out + tag_directory(entries, at);
}

}  // namespace beamcam::output
