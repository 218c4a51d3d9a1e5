// Layout: W3C PNG specification (second edition), chunk by chunk.
#include "output/png.hpp"

#include <libdeflate.h>
#ifdef BEAMCAM_ISAL
#include <isa-l/igzip_lib.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <new>
#include <stdexcept>
#include <vector>

#include "output/pixels.hpp"

namespace beamcam::output {

namespace {

#ifndef BEAMCAM_ISAL
constexpr int kCompressionLevel = 2;  // a fifth of the time of libpng's defaults
#endif
constexpr char kFilterUp = 2;  // each byte less the one above it
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

// Every row behind a filter byte, each byte less the one above it; above the first row stand zeros.
std::string filtered(const std::string& bytes, std::size_t row_size) {
    const std::size_t rows = bytes.size() / row_size;
    std::string result(bytes.size() + rows, kFilterUp);
    for (std::size_t row = 0; row < rows; ++row) {
        const char* now = bytes.data() + row * row_size;
        char* out = result.data() + row * (row_size + 1) + 1;
        if (row == 0)
            std::copy_n(now, row_size, out);
        else
            for (std::size_t i = 0; i < row_size; ++i) out[i] = static_cast<char>(now[i] - now[i - row_size]);
    }
    return result;
}

// The same of opaque pictures, straight from the pixels: where a run of them is as above, nothing is computed.
std::string filtered_rgb(const render::Image& image) {
    constexpr std::size_t kRun = 32;  // [px]
    const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
    std::string result((3 * width + 1) * height, '\0');
    const std::vector<std::uint32_t> black(width, 0);
    const std::uint32_t* above = black.data();
    for (std::size_t row = 0; row < height; ++row) {
        const std::uint32_t* now = image.pixels.data() + row * width;
        char* out = result.data() + row * (3 * width + 1);
        *out++ = kFilterUp;
        for (std::size_t from = 0; from < width; from += kRun) {
            const std::size_t to = std::min(from + kRun, width);
            if (std::equal(now + from, now + to, above + from)) continue;
            for (std::size_t x = from; x < to; ++x)
                for (std::size_t c = 0; c < 3; ++c)
                    out[3 * x + c] = static_cast<char>((now[x] >> (16 - 8 * c)) - (above[x] >> (16 - 8 * c)));
        }
        above = now;
    }
    return result;
}

#ifdef BEAMCAM_ISAL
// Ten times as fast as libdeflate on these rows, which are mostly zeros, and a fifth larger.
std::string compressed(const std::string& data) {
    isal_zstream stream;
    isal_deflate_init(&stream);
    std::vector<std::uint8_t> tables(ISAL_DEF_LVL1_DEFAULT);
    stream.level = 1;
    stream.level_buf = tables.data();
    stream.level_buf_size = static_cast<std::uint32_t>(tables.size());
    stream.gzip_flag = IGZIP_ZLIB;
    stream.end_of_stream = 1;
    stream.flush = NO_FLUSH;
    std::string result;
    constexpr std::size_t kPiece = std::size_t{1} << 20;
    std::size_t taken = 0;
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(data.data());
    do {
        const std::size_t there = result.size();
        result.resize(there + kPiece);
        stream.next_out = reinterpret_cast<std::uint8_t*>(result.data() + there);
        stream.avail_out = kPiece;
        stream.next_in = const_cast<std::uint8_t*>(bytes + taken);
        const std::size_t more = std::min(data.size() - taken, kLongestChunk);
        stream.avail_in = static_cast<std::uint32_t>(more);
        stream.end_of_stream = taken + more == data.size();
        if (isal_deflate(&stream) != COMP_OK) throw std::runtime_error("ISA-L cannot compress a picture");
        taken += more - stream.avail_in;
        result.resize(there + kPiece - stream.avail_out);
    } while (stream.internal_state.state != ZSTATE_END);
    return result;
}
#else
std::string compressed(const std::string& data) {
    const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
        libdeflate_alloc_compressor(kCompressionLevel), libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    std::string result(libdeflate_zlib_compress_bound(compressor.get(), data.size()), '\0');
    result.resize(libdeflate_zlib_compress(compressor.get(), data.data(), data.size(), result.data(), result.size()));
    return result;
}
#endif

}  // namespace

std::string encode_png(const render::Image& image, const PngOptions& options) {
    if (image.width <= 0 || image.height <= 0) throw std::logic_error("encode_png: an empty image");
    const bool opaque = is_opaque(image);
    const std::string rows =
        opaque ? filtered_rgb(image) : filtered(rgba_bytes(image), 4 * static_cast<std::size_t>(image.width));

    std::string file = "\x89PNG\r\n\x1a\n";
    put_chunk(file, "IHDR", header(image, opaque));
    put_chunk(file, "sRGB", std::string_view("\0", 1));  // rendering intent: perceptual
    if (options.dpi) put_chunk(file, "pHYs", pixels_per_metre(*options.dpi));
    for (const auto& [keyword, text] : options.metadata) put_chunk(file, "iTXt", international_text(keyword, text));
    put_chunk(file, "IDAT", compressed(rows));
    put_chunk(file, "IEND", {});
    return file;
}

void write_png(const std::filesystem::path& file, const render::Image& image, const PngOptions& options,
               Durability durability) {
    write_file(file, encode_png(image, options), durability);
}

}  // namespace beamcam::output
