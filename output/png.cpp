// Layout: W3C PNG specification (second edition), chunk by chunk.
#include "output/png.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <new>

#include "output/pixels.hpp"

namespace beamcam::output {

namespace {

constexpr int kCompressionLevel = 2;  // 6 ms for 1920×1080 where libpng's defaults take 34
constexpr char kFilterUp = 2;         // each byte less the one above it
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
    const bool printable = std::all_of(keyword.begin(), keyword.end(), [](char c) { return c >= ' ' && c <= '~'; });
    if (keyword.empty() || keyword.size() > 79 || !printable || keyword.front() == ' ' || keyword.back() == ' ')
        throw UnsupportedOption("\"" + keyword + "\" cannot be a PNG metadata keyword; use 1 to 79 ASCII characters");
    if (text.find('\0') != std::string::npos)
        throw UnsupportedOption("the PNG metadata \"" + keyword + "\" contains a zero byte");
    std::string data = keyword;
    data += {'\0', 0, 0, '\0', '\0'};  // not compressed, method 0, no language, no translated keyword
    return data + text;
}

// Every row behind a filter byte, each byte less the one above it.
std::string filtered(const std::string& bytes, std::size_t row_size) {
    const std::size_t rows = bytes.size() / row_size;
    std::string result(bytes.size() + rows, kFilterUp);
    for (std::size_t row = 0; row < rows; ++row) {
        const char* now = bytes.data() + row * row_size;
        char* out = result.data() + row * (row_size + 1) + 1;
        if (row == 0)
            std::copy_n(now, row_size, out);  // above the first row stand zeros
        else
            for (std::size_t i = 0; i < row_size; ++i) out[i] = static_cast<char>(now[i] - now[i - row_size]);
    }
    return result;
}

std::string compressed(const std::string& data) {
    const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
        libdeflate_alloc_compressor(kCompressionLevel), libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    std::string result(libdeflate_zlib_compress_bound(compressor.get(), data.size()), '\0');
    result.resize(libdeflate_zlib_compress(compressor.get(), data.data(), data.size(), result.data(), result.size()));
    return result;
}

}  // namespace

std::string encode_png(const render::Image& image, const PngOptions& options) {
    if (image.width <= 0 || image.height <= 0) throw std::logic_error("encode_png: an empty image");
    const bool opaque = is_opaque(image);
    const std::string bytes = opaque ? rgb_bytes(image) : rgba_bytes(image);

    std::string file = "\x89PNG\r\n\x1a\n";
    put_chunk(file, "IHDR", header(image, opaque));
    put_chunk(file, "sRGB", std::string_view("\0", 1));  // rendering intent: perceptual
    if (options.dpi) put_chunk(file, "pHYs", pixels_per_metre(*options.dpi));
    for (const auto& [keyword, text] : options.metadata) put_chunk(file, "iTXt", international_text(keyword, text));
    put_chunk(file, "IDAT", compressed(filtered(bytes, bytes.size() / static_cast<std::size_t>(image.height))));
    put_chunk(file, "IEND", {});
    return file;
}

void write_png(const std::filesystem::path& file, const render::Image& image, const PngOptions& options,
               Durability durability) {
    write_file(file, encode_png(image, options), durability);
}

}  // namespace beamcam::output
