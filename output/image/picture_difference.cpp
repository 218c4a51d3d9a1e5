#include "output/image/picture_difference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "render/draw/color.hpp"

namespace beamcam::output {

namespace {

// Brightness of a pixel over white paper, 0…255.
double brightness(const std::uint8_t* p) {
    const double y = render::kLumaRed * p[0] + render::kLumaGreen * p[1] + render::kLumaBlue * p[2];
    return p[3] == 255 ? y : 255 + (y - 255) * p[3] / 255;
}

int channel_difference(const std::uint8_t* p, const std::uint8_t* q) {
    int largest = 0;
    for (int i = 0; i < 4; ++i) largest = std::max(largest, std::abs(int(p[i]) - int(q[i])));
    return largest;
}

void require_one_size(const Raster& a, const Raster& b) {
    if (a.width != b.width || a.height != b.height) throw std::logic_error("difference of pictures of two sizes");
}

// ---- structural similarity ---------------------------------------------------------------------

struct Sums {
    double a = 0, b = 0, squares = 0, products = 0;
    Sums& operator+=(const Sums& o) {
        a += o.a, b += o.b, squares += o.squares, products += o.products;
        return *this;
    }
};

Sums sums_of(const Raster& a, const Raster& b, int left, int top, int right, int bottom) {
    Sums s;
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) {
            const double p = brightness(a.at(x, y)), q = brightness(b.at(x, y));
            s += {p, q, p * p + q * q, p * q};
        }
    return s;
}

// (2 μ_a μ_b + c₁)(2 σ_ab + c₂) / ((μ_a² + μ_b² + c₁)(σ_a² + σ_b² + c₂)), c = (0.01·255)², (0.03·255)².
double similarity(const Sums& s, double count) {
    constexpr double c1 = 0.01 * 255 * 0.01 * 255, c2 = 0.03 * 255 * 0.03 * 255;
    const double mean_a = s.a / count, mean_b = s.b / count;
    // Unbiased, as in the filter; one pixel has no variance.
    const double spread = std::max(count - 1, 1.0);
    const double variances = (s.squares - count * (mean_a * mean_a + mean_b * mean_b)) / spread;
    const double covariance = (s.products - count * mean_a * mean_b) / spread;
    return (2 * mean_a * mean_b + c1) * (2 * covariance + c2) /
           ((mean_a * mean_a + mean_b * mean_b + c1) * (variances + c2));
}

void measure_similarity(const Raster& a, const Raster& b, PictureDifference& d) {
    constexpr int kBlock = 4;
    const int columns = a.width / kBlock, rows = a.height / kBlock;
    if (columns < 2 || rows < 2) {  // smaller than a window: the picture is the window
        d.ssim = similarity(sums_of(a, b, 0, 0, a.width, a.height), static_cast<double>(a.pixels()));
        return;
    }
    // A window consists of four blocks of 4 × 4; the sums of two rows of blocks are kept.
    std::array<std::vector<Sums>, 2> kept;
    for (auto& row : kept) row.resize(static_cast<std::size_t>(columns));
    double total = 0;
    for (int row = 0; row < rows; ++row) {
        auto& now = kept[static_cast<std::size_t>(row % 2)];
        const auto& above = kept[static_cast<std::size_t>((row + 1) % 2)];
        for (int c = 0; c < columns; ++c)
            now[static_cast<std::size_t>(c)] =
                sums_of(a, b, c * kBlock, row * kBlock, (c + 1) * kBlock, (row + 1) * kBlock);
        for (std::size_t c = 1; row > 0 && c < static_cast<std::size_t>(columns); ++c) {
            Sums window = now[c];
            window += now[c - 1];
            window += above[c];
            window += above[c - 1];
            total += similarity(window, 64);
        }
    }
    d.ssim = total / (double(columns - 1) * (rows - 1));
}

// ---- the picture of the difference -------------------------------------------------------------

using Rgb = std::array<std::uint8_t, 3>;
constexpr Rgb kChanged{0xd5, 0x5e, 0x00}, kFrame{0x00, 0x72, 0xb2};

void put(Raster& r, int x, int y, const Rgb& color) {
    if (x < 0 || y < 0 || x >= r.width || y >= r.height) return;
    std::uint8_t* p = r.rgba.data() + (r.at(x, y) - r.rgba.data());
    std::copy(color.begin(), color.end(), p);
    p[3] = 255;
}

// Two pixels wide, four pixels outside the box.
void draw_frame(Raster& r, const PixelBox& box) {
    for (int away = 4; away <= 5; ++away) {
        for (int x = box.left - away; x < box.right + away; ++x) {
            put(r, x, box.top - away, kFrame);
            put(r, x, box.bottom - 1 + away, kFrame);
        }
        for (int y = box.top - away; y < box.bottom + away; ++y) {
            put(r, box.left - away, y, kFrame);
            put(r, box.right - 1 + away, y, kFrame);
        }
    }
}

}  // namespace

PictureDifference difference(const Raster& a, const Raster& b, int threshold) {
    require_one_size(a, b);
    PictureDifference d;
    d.pixels = a.pixels();
    if (a.rgba == b.rgba) return d;
    const std::size_t row_size = 4 * static_cast<std::size_t>(a.width);
    for (int y = 0; y < a.height; ++y) {
        if (std::memcmp(a.at(0, y), b.at(0, y), row_size) == 0) continue;
        for (int x = 0; x < a.width; ++x) {
            const int step = channel_difference(a.at(x, y), b.at(x, y));
            d.largest = std::max(d.largest, step);
            if (step <= threshold) continue;
            ++d.changed;
            d.box.add(x, y);
        }
    }
    measure_similarity(a, b, d);
    return d;
}

Raster difference_picture(const Raster& a, const Raster& b, int threshold) {
    require_one_size(a, b);
    Raster picture(a.width, a.height);
    PixelBox box;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            // A quarter of the contrast, towards white, so that changed pixels are conspicuous.
            const auto grey = static_cast<std::uint8_t>(std::lround(255 - (255 - brightness(a.at(x, y))) / 4));
            Rgb color{grey, grey, grey};
            if (channel_difference(a.at(x, y), b.at(x, y)) > threshold) {
                color = kChanged;
                box.add(x, y);
            }
            put(picture, x, y, color);
        }
    if (!box.empty()) draw_frame(picture, box);
    return picture;
}

}  // namespace beamcam::output
