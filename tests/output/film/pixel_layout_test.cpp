#include "output/film/pixel_layout.hpp"

#include <cmath>

#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

struct Yuv {
    std::vector<std::uint8_t> y, cb, cr;
};

Yuv converted(const render::Image& image) {
    const std::size_t width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
    Yuv yuv{std::vector<std::uint8_t>(width * height), std::vector<std::uint8_t>(width * height / 4),
            std::vector<std::uint8_t>(width * height / 4)};
    convert(image, PixelLayout::yuv420, nullptr,
            {{yuv.y.data(), yuv.cb.data(), yuv.cr.data()}, {image.width, image.width / 2, image.width / 2}},
            all_tiles(image));
    return yuv;
}

// BT.709 in floating point, unrounded; r, g, b in 0…255.
double luma(double r, double g, double b) { return 16 + 219 * (0.2126 * r + 0.7152 * g + 0.0722 * b) / 255; }
double cb_of(double r, double g, double b) {
    return 128 + 224 * (b - (0.2126 * r + 0.7152 * g + 0.0722 * b)) / 255 / 1.8556;
}
double cr_of(double r, double g, double b) {
    return 128 + 224 * (r - (0.2126 * r + 0.7152 * g + 0.0722 * b)) / 255 / 1.5748;
}

// Coefficients are rounded to 2⁻¹⁷: three terms of at most 255, after rounding to half a level.
constexpr double kTolerance = 0.5 + 3 * 255 / 131072.0;

TEST(Yuv, AgreesWithTheFormulaOnACubeOfColours) {
    for (int r = 0; r < 256; r += 15)
        for (int g = 0; g < 256; g += 15)
            for (int b = 0; b < 256; b += 15) {
                const Yuv yuv =
                    converted(flat_image(2, 2, 0xff000000u | unsigned(r) << 16 | unsigned(g) << 8 | unsigned(b)));
                ASSERT_NEAR(yuv.y[0], luma(r, g, b), kTolerance) << r << " " << g << " " << b;
                ASSERT_NEAR(yuv.cb[0], cb_of(r, g, b), kTolerance) << r << " " << g << " " << b;
                ASSERT_NEAR(yuv.cr[0], cr_of(r, g, b), kTolerance) << r << " " << g << " " << b;
            }
}

TEST(Yuv, GreysHaveNoColourAndSpanTheLimitedRange) {
    for (unsigned level = 0; level < 256; ++level) {
        const Yuv yuv = converted(flat_image(2, 2, 0xff000000u | level * 0x010101u));
        EXPECT_EQ(yuv.cb[0], 128) << level;
        EXPECT_EQ(yuv.cr[0], 128) << level;
        EXPECT_EQ(yuv.y[0], std::lround(16 + 219 * level / 255.0)) << level;
    }
}

TEST(Yuv, ChromaIsTheMeanOfItsFourPixels) {
    render::Image image(2, 2);
    image.pixels = {0xffff0000, 0xff00ff00, 0xff0000ff, 0xff808080};
    const Yuv yuv = converted(image);
    const double mean = (255 + 128) / 4.0;
    EXPECT_NEAR(yuv.cb[0], cb_of(mean, mean, mean), kTolerance);
    image.pixels = {0xffff0000, 0xffff0000, 0xff0000ff, 0xff0000ff};
    EXPECT_NEAR(converted(image).cr[0], cr_of(127.5, 0, 127.5), kTolerance);
    EXPECT_NEAR(converted(image).cb[0], cb_of(127.5, 0, 127.5), kTolerance);
}

// Widths around the lengths of vector registers, so that the remainders of the loops are seen.
TEST(Yuv, EveryPixelLandsInItsPlaceAtAnyEvenWidth) {
    for (int width : {2, 6, 14, 16, 18, 30, 34, 66, 130}) {
        render::Image image(width, 4);
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            image.pixels[i] = 0xff000000u | static_cast<std::uint32_t>(i * 2654435761u >> 8 & 0xffffff);
        const Yuv yuv = converted(image);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < width; ++x) {
                const std::uint32_t p = image.pixels[static_cast<std::size_t>(y * width + x)];
                ASSERT_NEAR(yuv.y[static_cast<std::size_t>(y * width + x)], luma(p >> 16 & 255, p >> 8 & 255, p & 255),
                            kTolerance)
                    << width << ": " << x << ", " << y;
            }
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < width / 2; ++x) {
                double r = 0, g = 0, b = 0;
                for (int k = 0; k < 4; ++k) {
                    const std::uint32_t p =
                        image.pixels[static_cast<std::size_t>((2 * y + k / 2) * width + 2 * x + k % 2)];
                    r += (p >> 16 & 255) / 4.0, g += (p >> 8 & 255) / 4.0, b += (p & 255) / 4.0;
                }
                const std::size_t at = static_cast<std::size_t>(y * width / 2 + x);
                ASSERT_NEAR(yuv.cb[at], cb_of(r, g, b), kTolerance) << width << ": " << x << ", " << y;
                ASSERT_NEAR(yuv.cr[at], cr_of(r, g, b), kTolerance) << width << ": " << x << ", " << y;
            }
    }
}

TEST(Yuv, RowsOfTheTargetMayBePadded) {
    std::vector<std::uint8_t> y(2 * 40, 7), c(20, 7), d(20, 7);
    const render::Image image = flat_image(4, 2, 0xffffffff);
    convert(image, PixelLayout::yuv420, nullptr, {{y.data(), c.data(), d.data()}, {40, 20, 20}}, all_tiles(image));
    EXPECT_EQ(y[3], 235);
    EXPECT_EQ(y[4], 7);
    EXPECT_EQ(y[40], 235);
    EXPECT_EQ(c[1], 128);
    EXPECT_EQ(c[2], 7);
}

TEST(Yuv, RefusesOddSizes) {
    for (const render::Image& image : {flat_image(3, 2, 0), flat_image(2, 3, 0)})
        EXPECT_THROW(convert(image, PixelLayout::yuv420, nullptr, FramePlanes(), all_tiles(image)), std::logic_error);
}

}  // namespace
}  // namespace beamcam::output
