// Layout: W3C PNG specification (second edition), chunk by chunk.
#include "output/image/png.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "output/files/inflate.hpp"
#include "output/image/raster.hpp"
#include "output/image/run_deflate.hpp"

namespace beamcam::output {

namespace {

constexpr int kCompressionLevel = 6;   // of libdeflate; higher levels take twice the time for 0.1 %
constexpr std::uint8_t kFilterUp = 2;  // each byte minus the byte above
using Pixels = std::span<const std::uint32_t>;
constexpr std::size_t kLongestChunk = 0x7fffffff;
constexpr std::size_t kSegment = 8;  // pixels that are compared at once with those above
static_assert(render::DirtyTiles::kWidth % kSegment == 0, "a segment lies in one tile");
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

// Two pixels, the first in the lower half.
std::uint64_t two_pixels(const std::uint32_t* from) {
    std::uint64_t both;
    std::memcpy(&both, from, sizeof both);
    return both;
}

// The differences of the bytes, modulo 256.
std::uint64_t difference_of(std::uint64_t now, std::uint64_t above) {
    constexpr std::uint64_t kHigh = 0x8080808080808080;  // the bits that must not borrow from the next byte
    return ((now | kHigh) - (above & ~kHigh)) ^ ((now ^ ~above) & kHigh);
}

// R, G, B from the lowest byte upwards.
std::uint64_t rgb(std::uint64_t pixel) { return __builtin_bswap32(static_cast<std::uint32_t>(pixel)) >> 8; }

// The bytes R, G, B of opaque pixels minus those of the pixels above; `out` needs space for 8 more bytes. False if a
// pixel is not opaque.
bool rgb_less_above(Pixels now, Pixels above, std::uint8_t* out) {
    static_assert(std::endian::native == std::endian::little, "pixels are taken two at once, in memory order");
    constexpr std::uint64_t kOpaque = 0xff000000'ff000000;
    std::uint64_t all = kOpaque;
    std::size_t x = 0;
    for (; x + 2 <= now.size(); x += 2, out += 6) {
        const std::uint64_t both = two_pixels(&now[x]), difference = difference_of(both, two_pixels(&above[x]));
        const std::uint64_t bytes = rgb(difference) | rgb(difference >> 32) << 24;
        std::memcpy(out, &bytes, sizeof bytes);
        all &= both;
    }
    if (x < now.size()) {
        const std::uint64_t bytes = rgb(difference_of(now[x], above[x]));
        std::memcpy(out, &bytes, sizeof bytes);
        all &= now[x] | kOpaque << 32;
    }
    return (all & kOpaque) == kOpaque;
}

// The same for any pixels: R, G, B, A.
void rgba_less_above(Pixels now, Pixels above, std::uint8_t* out) {
    std::vector<std::uint8_t> other(4 * above.size());
    rgba_bytes(now, out);
    rgba_bytes(above, other.data());
    for (std::size_t i = 0; i < 4 * now.size(); ++i) out[i] = static_cast<std::uint8_t>(out[i] - other[i]);
}

// Without an early exit, so that compilers vectorize it.
bool segment_differs(const std::uint32_t* now, const std::uint32_t* above) {
    std::uint32_t differences = 0;
    for (std::size_t i = 0; i < kSegment; ++i) differences |= now[i] ^ above[i];
    return differences != 0;
}

// Pixels from … to − 1; empty at the end of the row.
struct Segment {
    std::size_t from, to;
};

// The next pixels from `x` on that may differ from those above.
Segment next_changed(std::span<const std::uint8_t> changed, std::size_t x, std::size_t width) {
    const auto find = [&](std::size_t at, int value) {
        const void* found = std::memchr(changed.data() + at, value, changed.size() - at);
        return found ? static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - changed.data())
                     : changed.size();
    };
    const std::size_t first = find(x / kSegment, 1);
    return {std::min(first * kSegment, width), std::min(find(first, 0) * kSegment, width)};
}

// Passes every row to `rows`: the filter byte, then each byte minus the byte above; above the first row are zeros.
// Skips pixels that equal those above. Returns false early if the picture is not `opaque`.
template <class Rows>
bool put_filtered(const render::Image& image, const PngSequence::ChangedSegments& segments, bool opaque, Rows& rows) {
    const auto width = static_cast<std::size_t>(image.width);
    const std::size_t pixel = opaque ? 3 : 4;  // [byte]
    const std::vector<std::uint32_t> nothing(width, opaque ? 0xff000000 : 0);
    std::vector<std::uint8_t> difference(pixel * width + 8);
    Pixels above = nothing;
    for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
        const Pixels now(image.pixels.data() + y * width, width);
        rows.bytes({&kFilterUp, 1});
        for (std::size_t x = 0; x < width;) {
            const auto [from, to] = next_changed(segments.row(y), x, width);
            rows.zeros(pixel * (from - x));
            const Pixels here = now.subspan(from, to - from), there = above.subspan(from, to - from);
            x = to;
            if (opaque) {
                if (!rgb_less_above(here, there, difference.data())) return false;
            } else {
                rgba_less_above(here, there, difference.data());
            }
            rows.bytes({difference.data(), pixel * here.size()});
        }
        above = now;
    }
    return true;
}

// Like RunDeflate; libdeflate needs all rows in one piece.
class WholeDeflate {
  public:
    WholeDeflate(std::size_t pixel, const render::Image& image) {
        // At once, so that a picture of a gigabyte is not copied while it grows.
        rows_.reserve((pixel * static_cast<std::size_t>(image.width) + 1) * static_cast<std::size_t>(image.height));
    }
    void bytes(std::span<const std::uint8_t> data) { rows_.insert(rows_.end(), data.begin(), data.end()); }
    void zeros(std::size_t count) { rows_.resize(rows_.size() + count, 0); }
    std::string finish() && {
        return zlib_compressed({reinterpret_cast<const char*>(rows_.data()), rows_.size()}, kCompressionLevel);
    }

  private:
    std::vector<std::uint8_t> rows_;
};

struct Compressed {
    bool opaque;
    std::string data;
};

// `deflate(bytes of a pixel)` creates the compressor of the rows.
template <class Make>
Compressed compressed(const render::Image& image, const PngSequence::ChangedSegments& segments, Make deflate) {
    if (auto rgb = deflate(3); put_filtered(image, segments, true, rgb)) return {true, std::move(rgb).finish()};
    auto rgba = deflate(4);
    put_filtered(image, segments, false, rgba);
    return {false, std::move(rgba).finish()};
}

std::string png_file(const render::Image& image, const PngSequence::ChangedSegments& segments,
                     const PngOptions& options) {
    const auto [opaque, data] =
        options.compression == PngCompression::small
            ? compressed(image, segments, [&](std::size_t pixel) { return WholeDeflate(pixel, image); })
            : compressed(image, segments, [](std::size_t pixel) { return RunDeflate(pixel); });
    std::string file = "\x89PNG\r\n\x1a\n";
    put_chunk(file, "IHDR", header(image, opaque));
    put_chunk(file, "sRGB", std::string_view("\0", 1));  // rendering intent: perceptual
    if (options.dpi) put_chunk(file, "pHYs", pixels_per_metre(*options.dpi));
    for (const auto& [keyword, text] : options.metadata) put_chunk(file, "iTXt", international_text(keyword, text));
    put_chunk(file, "IDAT", data);
    put_chunk(file, "IEND", {});
    return file;
}

}  // namespace

// ---- sequences of pictures ---------------------------------------------------------

PngSequence::ChangedSegments::ChangedSegments(int width, int height)
    : columns_((static_cast<std::size_t>(width) + kSegment - 1) / kSegment),
      segments_(columns_ * static_cast<std::size_t>(height), 1) {}

std::span<const std::uint8_t> PngSequence::ChangedSegments::row(std::size_t y) const {
    return {segments_.data() + y * columns_, columns_};
}

// The row below a tile is compared with the last row of the tile.
void PngSequence::ChangedSegments::compare(const render::Image& image, const render::DirtyTiles& changed) {
    const auto width = static_cast<std::size_t>(image.width);
    changed.for_each_run([&](int left, int top, int right, int bottom) {
        const auto end = static_cast<std::size_t>(right);
        for (int row = std::max(top, 1); row <= std::min(bottom, image.height - 1); ++row) {
            const auto y = static_cast<std::size_t>(row);
            const std::uint32_t *now = image.pixels.data() + y * width, *above = now - width;
            for (auto x = static_cast<std::size_t>(left); x < end; x += kSegment)
                segments_[y * columns_ + x / kSegment] = x + kSegment <= end
                                                             ? segment_differs(now + x, above + x)
                                                             : !std::equal(now + x, now + end, above + x);
        }
    });
}

PngSequence::PngSequence(PngOptions options) : options_(std::move(options)) {}

const std::string& PngSequence::encode(const render::Image& image, const render::DirtyTiles& changed) {
    if (image.width <= 0 || image.height <= 0) throw std::logic_error("encode_png: an empty image");
    if (file_.empty())
        segments_ = ChangedSegments(image.width, image.height);
    else if (!changed.any())
        return file_;
    segments_.compare(image, changed);
    return file_ = png_file(image, segments_, options_);
}

std::string encode_png(const render::Image& image, const PngOptions& options) {
    render::DirtyTiles all(image.width, image.height);
    all.add_all();
    return PngSequence(options).encode(image, all);
}

void write_png(const Target& file, const render::Image& image, const PngOptions& options) {
    write_file(file, encode_png(image, options));
}

}  // namespace beamcam::output
