#include "output/image/png.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "output/image/raster.hpp"
#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

// libpng's reading of the file: a witness that shares no code with the writer.
struct Decoded {
    int width = 0, height = 0;
    bool alpha = false;
    std::string rgba;
};

Decoded decoded(const std::string& file) {
    png_image image = {};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_memory(&image, file.data(), file.size()), 0) << image.message;
    Decoded result{
        static_cast<int>(image.width), static_cast<int>(image.height), (image.format & PNG_FORMAT_FLAG_ALPHA) != 0, {}};
    image.format = PNG_FORMAT_RGBA;
    result.rgba.resize(PNG_IMAGE_SIZE(image));
    EXPECT_NE(png_image_finish_read(&image, nullptr, result.rgba.data(), 0, nullptr), 0) << image.message;
    EXPECT_EQ(image.warning_or_error, 0u) << image.message;
    return result;
}

constexpr std::array kCompressions = {PngCompression::small, PngCompression::quick};

TEST(Png, DecodesToTheSamePixelsAtAnySize) {
    for (bool opaque : {true, false})
        for (auto [width, height] : {std::pair{1, 1}, {1, 7}, {7, 1}, {33, 5}, {257, 129}}) {
            const render::Image image = pattern(width, height, opaque);
            for (PngCompression compression : kCompressions) {
                const Decoded png = decoded(encode_png(image, {{}, {}, compression}));
                EXPECT_EQ(png.width, width);
                EXPECT_EQ(png.height, height);
                EXPECT_EQ(png.rgba, rgba_bytes(image))
                    << width << "x" << height << (opaque ? " opaque" : " transparent");
            }
        }
}

// Rows that are partly as above, and more than compresses in one go.
TEST(Png, DecodesToTheSamePixelsWhateverTheyAre) {
    render::Image drawing = pattern(1000, 40, true), noise(900, 800);
    for (std::size_t i = 0; i < drawing.pixels.size(); ++i)
        if (i % 1000 < 900) drawing.pixels[i] = i % 1000 > 450 && i / 1000 % 7 == 3 ? 0xff102030U : 0xfff4f1eaU;
    std::uint32_t state = 1;
    for (std::uint32_t& pixel : noise.pixels) pixel = 0xff000000U | (state = state * 1664525U + 1013904223U) >> 8;
    for (const render::Image& image : {drawing, noise})
        for (PngCompression compression : kCompressions)
            EXPECT_EQ(decoded(encode_png(image, {{}, {}, compression})).rgba, rgba_bytes(image)) << image.width;
}

// Rows in which what is as above and what is not change places at every distance.
TEST(Png, DecodesToTheSamePixelsWhereverTheyDifferFromThoseAbove) {
    std::uint32_t state = 3;
    const auto any = [&](std::uint32_t below) { return ((state = state * 1664525U + 1013904223U) >> 8) % below; };
    for (int width : {1, 7, 8, 9, 63, 64, 65, 333}) {
        render::Image image(width, 120);
        std::fill(image.pixels.begin(), image.pixels.end(), 0xfff4f1eaU);
        for (int y = 1; y < image.height; ++y) {
            const auto row = image.pixels.begin() + std::ptrdiff_t(y) * width;
            std::copy_n(row - width, width, row);
            for (int x = static_cast<int>(any(40)); x < width; x += 1 + static_cast<int>(any(1U << y % 7)))
                row[x] = 0xff000000U | any(1U << 24);
        }
        for (PngCompression compression : kCompressions)
            EXPECT_TRUE(decoded(encode_png(image, {{}, {}, compression})).rgba == rgba_bytes(image)) << width;
    }
}

// Wherever the first pixel stands that is not opaque, and whatever is as above: all that was told till then is told
// anew.
TEST(Png, DecodesToTheSamePixelsWhereverOneIsNotOpaque) {
    for (std::size_t at : {0, 1, 99, 100, 131, 132, 4950, 9900, 9999})
        for (std::uint32_t other : {0x80402010U, 0xfe000000U, 0x00000000U}) {
            render::Image image(100, 100);
            std::fill(image.pixels.begin(), image.pixels.end(), 0xfff4f1eaU);
            for (std::size_t i = 4000; i < 4700; ++i) image.pixels[i] = 0xff000000U | static_cast<std::uint32_t>(i * i);
            image.pixels[at] = other;
            for (PngCompression compression : kCompressions) {
                const Decoded png = decoded(encode_png(image, {{}, {}, compression}));
                EXPECT_TRUE(png.alpha);
                EXPECT_EQ(png.rgba, rgba_bytes(image)) << at;
            }
        }
}

// However a picture came about, its bytes are those of the picture alone: tiles that changed and rows below them, none,
// all, and more tiles told than changed.
TEST(Png, SequencesGiveTheBytesOfEachPictureAlone) {
    for (auto [width, height] : {std::pair{200, 70}, {33, 17}, {1, 1}, {64, 32}})
        for (bool opaque : {true, false})
            for (PngCompression compression : kCompressions) {
                const PngOptions options{{}, {{"Title", "one of many"}}, compression};
                PngSequence sequence(options);
                render::Image image = pattern(width, height, opaque);
                for (std::size_t i = 0; i < image.pixels.size(); ++i)
                    if (i / 3 % 5 != 0) image.pixels[i] = 0xfff4f1eaU;
                render::DirtyTiles changed(width, height);
                changed.add_all();
                EXPECT_EQ(sequence.encode(image, changed), encode_png(image, options));
                std::uint32_t state = 7;
                const auto any = [&](int below) {
                    return static_cast<int>((state = state * 1664525U + 1013904223U) >> 8) % below;
                };
                for (int round = 0; round < 60; ++round) {
                    changed.clear();
                    for (int spot = any(4); spot > 0; --spot) {
                        const int x = any(width), y = any(height), right = std::min(width, x + 1 + any(40)),
                                  bottom = std::min(height, y + 1 + any(20));
                        const std::uint32_t ink =
                            any(2) ? 0xfff4f1eaU : 0xff000000U | static_cast<std::uint32_t>(any(1 << 24));
                        for (int row = y; row < bottom; ++row)
                            std::fill_n(image.pixels.begin() + row * width + x, right - x, ink);
                        changed.add({double(x), double(y), right - x - 0.5, bottom - y - 0.5});
                    }
                    ASSERT_EQ(sequence.encode(image, changed), encode_png(image, options)) << width << ' ' << round;
                }
            }
}

TEST(Png, DrawingsAreSmallInSequencesToo) {
    render::Image image(1280, 720);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {  // a slanted bar with soft edges
        const std::size_t x = i % 1280, y = i / 1280, into = x + y - std::min(x + y, 2 * y);
        image.pixels[i] =
            0xff000000U | 0x010101U * static_cast<std::uint32_t>(into > 200 && into < 400 ? 40 + y % 5 : 240);
    }
    const std::size_t small = encode_png(image).size(),
                      quick = encode_png(image, {{}, {}, PngCompression::quick}).size();
    EXPECT_LE(small, quick);
    EXPECT_LT(quick, 20'000u);  // of 2.8 MB
}

TEST(Png, HasAnAlphaChannelOnlyWhereItIsNeeded) {
    for (PngCompression compression : kCompressions) {
        EXPECT_FALSE(decoded(encode_png(pattern(9, 9, true), {{}, {}, compression})).alpha);
        EXPECT_TRUE(decoded(encode_png(pattern(9, 9, false), {{}, {}, compression})).alpha);
    }
}

// Keyword and text of every text chunk, in libpng's reading.
std::vector<std::pair<std::string, std::string>> texts(const std::filesystem::path& file) {
    std::vector<std::pair<std::string, std::string>> found;
    FILE* stream = fopen(file.c_str(), "rb");
    if (stream == nullptr) throw std::runtime_error("cannot open the picture");
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, stream);
    png_read_info(png, info);
    png_textp text = nullptr;
    const int count = png_get_text(png, info, &text, nullptr);
    for (int i = 0; i < count; ++i) found.emplace_back(text[i].key, text[i].text);
    png_destroy_read_struct(&png, &info, nullptr);
    fclose(stream);
    return found;
}

TEST(Png, CarriesItsMetadataAndResolution) {
    Scratch scratch;
    const std::map<std::string, std::string> metadata = {{"Title", "Fall on a cam, θ₀ = 45°"}, {"beamcam", "{}"}};
    write_png(scratch / "a.png", pattern(8, 8, true), {300.0, metadata});
    const auto found = texts(scratch / "a.png");
    EXPECT_EQ((std::map<std::string, std::string>(found.begin(), found.end())), metadata);
    // 300 per inch are 11811 per metre, on both axes, unit metre.
    const std::string bytes = read_file(scratch / "a.png");
    EXPECT_NE(bytes.find(std::string("pHYs\0\0\x2e\x23\0\0\x2e\x23\x01", 13)), std::string::npos);
}

TEST(Png, RefusesWhatTheFormatCannotHold) {
    const render::Image image = pattern(2, 2, true);
    EXPECT_THROW(encode_png(image, {0.0, {}}), UnsupportedOption);
    EXPECT_THROW(encode_png(image, {std::nan(""), {}}), UnsupportedOption);
    EXPECT_THROW(encode_png(image, {{}, {{"", "x"}}}), UnsupportedOption);
    EXPECT_THROW(encode_png(image, {{}, {{std::string(80, 'k'), "x"}}}), UnsupportedOption);
    EXPECT_THROW(encode_png(image, {{}, {{"Title", std::string("a\0b", 3)}}}), UnsupportedOption);
    EXPECT_THROW(encode_png(render::Image()), std::logic_error);
}

TEST(Png, SamePictureGivesTheSameBytes) {
    for (PngCompression compression : kCompressions)
        EXPECT_EQ(encode_png(pattern(640, 64, true), {{}, {}, compression}),
                  encode_png(pattern(640, 64, true), {{}, {}, compression}));
}

}  // namespace
}  // namespace beamcam::output
