// Layout: W3C PNG specification (second edition), chunk by chunk.
#include "output/png.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "output/pixels.hpp"
#include "output/run_deflate.hpp"

namespace beamcam::output {

namespace {

constexpr int kCompressionLevel = 6;   // of libdeflate; higher ones take twice the time for a part in a thousand
constexpr std::uint8_t kFilterUp = 2;  // each byte less the one above it
using Pixels = std::span<const std::uint32_t>;
constexpr std::size_t kLongestChunk = 0x7fffffff;
constexpr std::size_t kStretch = 32;  // pixels that are compared with those above at once
constexpr double kMetresPerInch = 0.0254;

void put_u32(std::string& out, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(value >> shift & 0xff));
}

// Length, type, data, and the CRC of type and data.
void put_chunk(std::string& file, const char* type, std::string_view data) {
    if (data.size() > kLongestChunk)
        throw UnsupportedOption("the picture or its metadata is too large for a PNG file; use a smaller size");
    put_u32(file, static_cast<std::uint32_t>(data.size()));
    const std::size_t start = file.size();
    file.append(type, 4).append(data);
    put_u32(file, libdeflate_crc32(0, file.data() + start, file.size() - start));
}

std::string header(const render::Image& image, bool opaque) {
    std::string data;
    put_u32(data, static_cast<std::uint32_t>(image.width));
    put_u32(data, static_cast<std::uint32_t>(image.height));
    data += {8, static_cast<char>(opaque ? 2 : 6), 0, 0, 0};  // bits, colour type, deflate, filter set, no interlace
    return data;
}

std::string pixels_per_metre(double dpi) {
    const double density = std::round(dpi / kMetresPerInch);
    if (!(density >= 1 && density <= 0x7fffffff))
        throw UnsupportedOption("a resolution of " + std::to_string(dpi) +
                                " dpi is not possible in a PNG file; use a positive one such as 300");
    std::string data;
    put_u32(data, static_cast<std::uint32_t>(density));
    put_u32(data, static_cast<std::uint32_t>(density));
    data.push_back(1);  // per metre
    return data;
}

std::string international_text(const std::string& keyword, const std::string& text) {
    const bool printable = std::all_of(keyword.begin(), keyword.end(), [](char c) { return c >= ' ' && c <= '~'; });
    if (keyword.empty() || keyword.size() > 79 || !printable || keyword.front() == ' ' || keyword.back() == ' ')
        throw UnsupportedOption("\"" + keyword + "\" cannot be a PNG metadata keyword; use 1 to 79 ASCII characters");
    if (text.find('\0') != std::string::npos)
        throw UnsupportedOption("the PNG metadata \"" + keyword + "\" contains a zero byte");
    std::string data = keyword;
    data += {'\0', 0, 0, '\0', '\0'};  // not compressed, method 0, no language, no translated keyword
    return data + text;
}

// The bytes of pixels less those of the pixels above: of opaque ones R, G, B, and one byte behind the last pixel is
// spoilt.
void rgb_less_above(Pixels now, Pixels above, std::uint8_t* out) {
    constexpr std::uint32_t kHigh = 0x80808080;  // the bits that must not borrow from the next byte
    for (std::size_t x = 0; x < now.size(); ++x, out += 3) {
        const std::uint32_t less = ((now[x] | kHigh) - (above[x] & ~kHigh)) ^ ((now[x] ^ ~above[x]) & kHigh);
        const std::uint32_t bytes = (less >> 16 & 0xff) | (less & 0xff00) | (less & 0xff) << 16;
        std::memcpy(out, &bytes, sizeof bytes);
    }
}

// The same of any pixels: R, G, B, A.
void rgba_less_above(Pixels now, Pixels above, std::uint8_t* out) {
    std::vector<std::uint8_t> other(4 * above.size());
    rgba_bytes(now, out);
    rgba_bytes(above, other.data());
    for (std::size_t i = 0; i < 4 * now.size(); ++i) out[i] = static_cast<std::uint8_t>(out[i] - other[i]);
}

// Tells `rows` every row behind its filter byte, each byte less the one above it; above the first row stand zeros. What
// is as above is not computed. False, early, if pixels said to be `opaque` are not: those as above are like them.
template <class Rows>
bool put_filtered(const render::Image& image, bool opaque, Rows& rows) {
    const auto width = static_cast<std::size_t>(image.width);
    const std::size_t pixel = opaque ? 3 : 4;  // [byte]
    const std::vector<std::uint32_t> nothing(width, opaque ? 0xff000000 : 0);
    std::vector<std::uint8_t> less(pixel * width + 1);
    Pixels above = nothing;
    for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
        const Pixels now(image.pixels.data() + y * width, width);
        const auto end_of = [&](std::size_t x, bool same) {
            while (x < width) {
                const std::size_t next = std::min(x + kStretch, width);
                if (std::equal(now.data() + x, now.data() + next, above.data() + x) != same) break;
                x = next;
            }
            return x;
        };
        rows.bytes({&kFilterUp, 1});
        for (std::size_t x = 0; x < width;) {
            const std::size_t from = end_of(x, true);
            rows.zeros(pixel * (from - x));
            x = end_of(from, false);
            const Pixels here = now.subspan(from, x - from), there = above.subspan(from, x - from);
            if (opaque && !is_opaque(here)) return false;
            (opaque ? rgb_less_above : rgba_less_above)(here, there, less.data());
            rows.bytes({less.data(), pixel * here.size()});
        }
        above = now;
    }
    return true;
}

// Like RunDeflate; libdeflate wants all rows in one piece.
class WholeDeflate {
  public:
    explicit WholeDeflate(std::size_t /*pixel*/) {}
    void bytes(std::span<const std::uint8_t> data) { rows_.insert(rows_.end(), data.begin(), data.end()); }
    void zeros(std::size_t count) { rows_.resize(rows_.size() + count, 0); }
    std::string finish() && {
        const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
            libdeflate_alloc_compressor(kCompressionLevel), libdeflate_free_compressor);
        if (!compressor) throw std::bad_alloc();
        std::string result(libdeflate_zlib_compress_bound(compressor.get(), rows_.size()), '\0');
        result.resize(
            libdeflate_zlib_compress(compressor.get(), rows_.data(), rows_.size(), result.data(), result.size()));
        return result;
    }

  private:
    std::vector<std::uint8_t> rows_;
};

struct Compressed {
    bool opaque;
    std::string data;
};

template <class Deflate>
Compressed compressed(const render::Image& image) {
    Deflate rgb(3);
    if (put_filtered(image, true, rgb)) return {true, std::move(rgb).finish()};
    Deflate rgba(4);
    put_filtered(image, false, rgba);
    return {false, std::move(rgba).finish()};
}

}  // namespace

std::string encode_png(const render::Image& image, const PngOptions& options) {
    if (image.width <= 0 || image.height <= 0) throw std::logic_error("encode_png: an empty image");
    const auto [opaque, data] =
        options.compression == PngCompression::small ? compressed<WholeDeflate>(image) : compressed<RunDeflate>(image);

    std::string file = "\x89PNG\r\n\x1a\n";
    put_chunk(file, "IHDR", header(image, opaque));
    put_chunk(file, "sRGB", std::string_view("\0", 1));  // rendering intent: perceptual
    if (options.dpi) put_chunk(file, "pHYs", pixels_per_metre(*options.dpi));
    for (const auto& [keyword, text] : options.metadata) put_chunk(file, "iTXt", international_text(keyword, text));
    put_chunk(file, "IDAT", data);
    put_chunk(file, "IEND", {});
    return file;
}

void write_png(const std::filesystem::path& file, const render::Image& image, const PngOptions& options,
               Durability durability) {
    write_file(file, encode_png(image, options), durability);
}

}  // namespace beamcam::output
