// Layout: W3C PNG specification (second edition), chunk by chunk.
#include "output/image/png.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "output/files/descriptor.hpp"
#include "output/image/raster.hpp"

namespace beamcam::output {

namespace {

// The level of libdeflate. For a picture of 1080p levels 2 to 6 take 7 ms to 11 ms, and level 6 makes the smallest
// files of these; level 7 takes a quarter more time, levels 1, 8 and 9 about twice the time or more.
constexpr int kCompressionLevel = 6;
constexpr std::uint8_t kFilterUp = 2;  // each byte minus the byte above
constexpr std::size_t kLongestChunk = 0x7fffffff;
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
    const bool printable = std::ranges::all_of(keyword, [](char c) { return c >= ' ' && c <= '~'; });
    if (keyword.empty() || keyword.size() > 79 || !printable || keyword.front() == ' ' || keyword.back() == ' ')
        throw UnsupportedOption("\"" + keyword + "\" cannot be a PNG metadata keyword; use 1 to 79 ASCII characters");
    if (text.find('\0') != std::string::npos)
        throw UnsupportedOption("the PNG metadata \"" + keyword + "\" contains a zero byte");
    std::string data = keyword;
    data += {'\0', 0, 0, '\0', '\0'};  // not compressed, method 0, no language, no translated keyword
    return data + text;
}

// R, G, B of opaque pixels; `out` needs space for one more byte.
void rgb_bytes(std::span<const std::uint32_t> pixels, std::uint8_t* out) {
    static_assert(std::endian::native == std::endian::little, "the lowest byte is written first");
    for (const std::uint32_t pixel : pixels) {
        const std::uint32_t rgb = __builtin_bswap32(pixel) >> 8;
        std::memcpy(out, &rgb, 4);
        out += 3;
    }
}

// Every row: the filter byte, then each byte minus the byte above; above the first row are zeros.
std::vector<std::uint8_t> filtered_rows(const render::Image& image, bool opaque) {
    const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
    const std::size_t size = (opaque ? 3 : 4) * width;  // of a row [byte]
    std::vector<std::uint8_t> rows((size + 1) * height), above(size + 1, 0), now(size + 1);
    std::uint8_t* out = rows.data();
    for (std::size_t y = 0; y < height; ++y) {
        (opaque ? rgb_bytes : rgba_bytes)({image.pixels.data() + y * width, width}, now.data());
        *out++ = kFilterUp;
        for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::uint8_t>(now[i] - above[i]);
        out += size;
        std::swap(now, above);
    }
    return rows;
}

std::string zlib_compressed(std::string_view bytes) {
    const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
        libdeflate_alloc_compressor(kCompressionLevel), libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    // Uninitialized: most of it is never used, and the system provides only memory that is used.
    const std::size_t most = libdeflate_zlib_compress_bound(compressor.get(), bytes.size());
    const auto room = std::make_unique_for_overwrite<char[]>(most);
    return {room.get(), libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), room.get(), most)};
}

}  // namespace

std::string encode_png(const render::Image& image, const PngOptions& options) {
    if (image.width <= 0 || image.height <= 0) throw std::logic_error("encode_png: an empty image");
    const bool opaque = is_opaque(image.pixels);
    std::string file = "\x89PNG\r\n\x1a\n";
    put_chunk(file, "IHDR", header(image, opaque));
    put_chunk(file, "sRGB", std::string_view("\0", 1));  // rendering intent: perceptual
    if (options.dpi) put_chunk(file, "pHYs", pixels_per_metre(*options.dpi));
    for (const auto& [keyword, text] : options.metadata) put_chunk(file, "iTXt", international_text(keyword, text));
    put_chunk(file, "IDAT", zlib_compressed(bytes_of(filtered_rows(image, opaque))));
    put_chunk(file, "IEND", {});
    return file;
}

void write_png(const FileTarget& file, const render::Image& image, const PngOptions& options) {
    write_file(file, encode_png(image, options));
}

}  // namespace beamcam::output
