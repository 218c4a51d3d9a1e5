#include "output/film/pixel_layout.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "output/image/raster.hpp"
#include "render/draw/color.hpp"

// Compilers vectorize the loops below; on x86-64 a wider version is chosen when the program starts. All versions give
// the same bytes. Sanitizers cannot instrument this choice.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define BEAMCAM_WIDEST __attribute__((target_clones("avx2", "sse4.1", "default")))
#else
#define BEAMCAM_WIDEST
#endif

namespace beamcam::output {

namespace {

using render::kLumaBlue;
using render::kLumaRed;

// Coefficients of the formula in the header, times 255 levels, with 16 fractional bits.
constexpr double kOne = 65536.0 / 255;
constexpr int rounded(double value) { return static_cast<int>(value < 0 ? value - 0.5 : value + 0.5); }

constexpr int kYR = rounded(219 * kOne * kLumaRed);
constexpr int kYB = rounded(219 * kOne * kLumaBlue);
constexpr int kYG = rounded(219 * kOne) - kYR - kYB;  // white is exactly 235
constexpr int kCbR = rounded(224 * kOne * -kLumaRed / (2 * (1 - kLumaBlue)));
constexpr int kCbB = rounded(224 * kOne * 0.5);
constexpr int kCbG = -kCbR - kCbB;  // greys are exactly 128
constexpr int kCrR = rounded(224 * kOne * 0.5);
constexpr int kCrB = rounded(224 * kOne * -kLumaBlue / (2 * (1 - kLumaRed)));
constexpr int kCrG = -kCrR - kCrB;

}  // namespace

// Two rows of pixels into two of luma and one of each chroma. `width` is even.
BEAMCAM_WIDEST void convert_two_rows(const std::uint32_t* __restrict above, const std::uint32_t* __restrict below,
                                     int width, std::uint8_t* __restrict y_above, std::uint8_t* __restrict y_below,
                                     std::uint8_t* __restrict cb, std::uint8_t* __restrict cr) {
    const auto luma = [](std::uint32_t p) __attribute__((always_inline)) {
        const int r = p >> 16 & 0xff, g = p >> 8 & 0xff, b = p & 0xff;
        return static_cast<std::uint8_t>((kYR * r + kYG * g + kYB * b + (16 << 16) + (1 << 15)) >> 16);
    };
    for (int x = 0; x < width; ++x) y_above[x] = luma(above[x]);
    for (int x = 0; x < width; ++x) y_below[x] = luma(below[x]);
    for (int x = 0; x < width / 2; ++x) {
        const std::uint32_t p = above[2 * x], q = above[2 * x + 1], s = below[2 * x], t = below[2 * x + 1];
        // Red and blue are summed side by side, each in 16 bits: four times 255 fits.
        const std::uint32_t rb = (p & 0xff00ff) + (q & 0xff00ff) + (s & 0xff00ff) + (t & 0xff00ff);
        const int r = static_cast<int>(rb >> 16), b = static_cast<int>(rb & 0xffff);
        const int g = static_cast<int>((p >> 8 & 0xff) + (q >> 8 & 0xff) + (s >> 8 & 0xff) + (t >> 8 & 0xff));
        constexpr int offset = (128 << 18) + (1 << 17);  // 18 bits: the sums are of four pixels
        cb[x] = static_cast<std::uint8_t>((kCbR * r + kCbG * g + kCbB * b + offset) >> 18);
        cr[x] = static_cast<std::uint8_t>((kCrR * r + kCrG * g + kCrB * b + offset) >> 18);
    }
}

namespace {

void convert_pair(const render::Image& image, const FramePlanes& to, int y, int left, int right) {
    const std::uint32_t* pixels = image.pixels.data() + std::ptrdiff_t(y) * image.width + left;
    convert_two_rows(pixels, pixels + image.width, right - left, to.plane[0] + y * to.stride[0] + left,
                     to.plane[0] + (y + 1) * to.stride[0] + left, to.plane[1] + y / 2 * to.stride[1] + left / 2,
                     to.plane[2] + y / 2 * to.stride[2] + left / 2);
}

// Four pixels with the upper left one at (x, y).
void convert_four(const render::Image& image, const FramePlanes& to, int x, int y) {
    int r = 0, g = 0, b = 0, weight = 0;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const StraightColor c =
                straight_color(image.pixels[std::size_t(y + j) * std::size_t(image.width) + std::size_t(x + i)]);
            to.plane[0][(y + j) * to.stride[0] + x + i] =
                static_cast<std::uint8_t>((kYR * c.r + kYG * c.g + kYB * c.b + (16 << 16) + (1 << 15)) >> 16);
            to.plane[3][(y + j) * to.stride[3] + x + i] = static_cast<std::uint8_t>(c.a);
            r += c.r * c.a, g += c.g * c.a, b += c.b * c.a, weight += c.a;
        }
    if (weight > 0) r = (r + weight / 2) / weight, g = (g + weight / 2) / weight, b = (b + weight / 2) / weight;
    constexpr int offset = (128 << 16) + (1 << 15);
    to.plane[1][y / 2 * to.stride[1] + x / 2] =
        static_cast<std::uint8_t>((kCbR * r + kCbG * g + kCbB * b + offset) >> 16);
    to.plane[2][y / 2 * to.stride[2] + x / 2] =
        static_cast<std::uint8_t>((kCrR * r + kCrG * g + kCrB * b + offset) >> 16);
}

void convert_row_10(const render::Image& image, const FramePlanes& to, int y, int left, int right) {
    const std::uint32_t* row = image.pixels.data() + std::ptrdiff_t(y) * image.width;
    std::array<std::uint16_t*, 4> out{};
    for (std::size_t i = 0; i < 4; ++i) out[i] = reinterpret_cast<std::uint16_t*>(to.plane[i] + y * to.stride[i]);
    for (int x = left; x < right; ++x) {
        const StraightColor c = straight_color(row[x]);
        // Two more bits: four times the levels of 8 bits.
        out[0][x] = static_cast<std::uint16_t>((kYR * c.r + kYG * c.g + kYB * c.b + (16 << 16) + (1 << 13)) >> 14);
        out[1][x] = static_cast<std::uint16_t>((kCbR * c.r + kCbG * c.g + kCbB * c.b + (128 << 16) + (1 << 13)) >> 14);
        out[2][x] = static_cast<std::uint16_t>((kCrR * c.r + kCrG * c.g + kCrB * c.b + (128 << 16) + (1 << 13)) >> 14);
        out[3][x] = static_cast<std::uint16_t>((c.a * 1023 + 127) / 255);
    }
}

// Bytes of each pixel in the order blue, green, red, alpha; colour not premultiplied.
void copy_row(const render::Image& image, const FramePlanes& to, int y, int left, int right) {
    constexpr std::ptrdiff_t kPixel = 4;  // [bytes]
    const std::uint32_t* row = image.pixels.data() + std::ptrdiff_t(y) * image.width;
    std::uint8_t* out = to.plane[0] + y * to.stride[0] + left * kPixel;
    for (int x = left; x < right; ++x) {
        const StraightColor c = straight_color(row[x]);
        for (const auto channel : {c.b, c.g, c.r, c.a}) *out++ = static_cast<std::uint8_t>(channel);
    }
}

}  // namespace

void convert(const render::Image& image, PixelLayout layout, const PaletteTable* table, const FramePlanes& to,
             const render::DirtyTiles& part) {
    if (layout == PixelLayout::indices) return table->convert(image, to.plane[0], to.stride[0], part);
    const bool in_pairs = layout == PixelLayout::yuv420 || layout == PixelLayout::yuva420;
    if (in_pairs && (image.width % 2 != 0 || image.height % 2 != 0))
        throw std::logic_error("convert: odd size " + std::to_string(image.width) + "x" + std::to_string(image.height));
    part.for_each_run([&](int left, int top, int right, int bottom) {
        for (int y = top; y < bottom; y += in_pairs ? 2 : 1) switch (layout) {
                case PixelLayout::yuv420:
                    convert_pair(image, to, y, left, right);
                    break;
                case PixelLayout::yuva420:
                    for (int x = left; x < right; x += 2) convert_four(image, to, x, y);
                    break;
                case PixelLayout::yuva444p10:
                    convert_row_10(image, to, y, left, right);
                    break;
                case PixelLayout::indices:
                case PixelLayout::bgra:
                    copy_row(image, to, y, left, right);
                    break;
            }
    });
}

}  // namespace beamcam::output
