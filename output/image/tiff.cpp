#include "output/image/tiff.hpp"

#include <libdeflate.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <new>
#include <vector>

#include "output/files/errors.hpp"

namespace beamcam::output {
namespace {

void put(std::string& out, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xff);
}

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

std::string deflated(const std::string& plain) {
    constexpr int kLevel = 9;
    const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
        libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    std::string out(libdeflate_zlib_compress_bound(compressor.get(), plain.size()), '\0');
    out.resize(libdeflate_zlib_compress(compressor.get(), plain.data(), plain.size(), out.data(), out.size()));
    return out;
}

// The entries of the directory, by ascending tags; values longer than four bytes follow the directory.
class Directory {
  public:
    enum Type { text = 2, short_number = 3, long_number = 4, ratio = 5 };

    void number(int tag, Type type, std::uint32_t value) {
        std::string bytes;
        put(bytes, value, 4);
        entries_.push_back({tag, type, 1, bytes});
    }
    void value(int tag, Type type, std::uint32_t count, std::string bytes) {
        entries_.push_back({tag, type, count, std::move(bytes)});
    }
    std::string bytes(std::size_t at) const {
        std::string out, behind;
        put(out, entries_.size(), 2);
        const std::size_t end = at + 2 + 12 * entries_.size() + 4;
        for (const Entry& e : entries_) {
            put(out, static_cast<std::uint64_t>(e.tag), 2), put(out, e.type, 2), put(out, e.count, 4);
            std::string value = e.bytes;
            if (value.size() > 4) {
                put(out, end + behind.size(), 4);
                behind += value + (value.size() % 2 ? std::string(1, '\0') : "");
            } else {
                value.resize(4, '\0');
                out += value;
            }
        }
        put(out, 0, 4);
        return out + behind;
    }

  private:
    struct Entry {
        int tag;
        Type type;
        std::uint32_t count;
        std::string bytes;
    };
    std::vector<Entry> entries_;
};

}  // namespace

std::string encode_tiff(const render::Image& image, const TiffOptions& options) {
    const std::string rows = rows_of(image);
    if (rows.size() > 0xf0000000) throw UnsupportedOption("a TIFF file cannot exceed 4 GiB; lower the dpi");
    std::string out("II*\0", 4);
    const std::string strip = deflated(rows);
    const std::size_t at = 8 + strip.size() + strip.size() % 2;
    put(out, at, 4);
    out += strip + (strip.size() % 2 ? std::string(1, '\0') : "");

    std::string bits, resolution;
    for (int i = 0; i < 3; ++i) put(bits, 8, 2);
    constexpr double kUnit = 1000;  // of the resolution's fraction
    put(resolution, static_cast<std::uint64_t>(std::llround(options.dpi * kUnit)), 4);
    put(resolution, static_cast<std::uint64_t>(kUnit), 4);
    const auto text = [](const std::string& words) { return words + std::string(1, '\0'); };
    const auto size = [](const std::string& words) { return static_cast<std::uint32_t>(words.size() + 1); };
    Directory d;
    d.number(256, Directory::long_number, static_cast<std::uint32_t>(image.width));
    d.number(257, Directory::long_number, static_cast<std::uint32_t>(image.height));
    d.value(258, Directory::short_number, 3, bits);
    d.number(259, Directory::short_number, 8);  // compression: deflate
    d.number(262, Directory::short_number, 2);  // RGB
    if (!options.description.empty())
        d.value(270, Directory::text, size(options.description), text(options.description));
    d.number(273, Directory::long_number, 8);  // where the strip begins
    d.number(277, Directory::short_number, 3);
    d.number(278, Directory::long_number, static_cast<std::uint32_t>(image.height));
    d.number(279, Directory::long_number, static_cast<std::uint32_t>(strip.size()));
    d.value(282, Directory::ratio, 1, resolution);
    d.value(283, Directory::ratio, 1, resolution);
    d.number(296, Directory::short_number, 2);  // inches
    if (!options.software.empty()) d.value(305, Directory::text, size(options.software), text(options.software));
    d.number(317, Directory::short_number, 2);  // predictor
    return out + d.bytes(at);
}

}  // namespace beamcam::output
