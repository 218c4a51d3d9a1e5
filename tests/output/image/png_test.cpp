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

TEST(Png, DecodesToTheSamePixelsAtAnySize) {
    for (bool opaque : {true, false})
        for (auto [width, height] : {std::pair{1, 1}, {1, 7}, {7, 1}, {33, 5}, {257, 129}}) {
            const render::Image image = pattern(width, height, opaque);
            const Decoded png = decoded(encode_png(image));
            EXPECT_EQ(png.width, width);
            EXPECT_EQ(png.height, height);
            EXPECT_EQ(png.rgba, rgba_bytes(image)) << width << "x" << height << (opaque ? " opaque" : " transparent");
        }
}

TEST(Png, DecodesToTheSamePixelsWhateverTheyAre) {
    render::Image drawing = pattern(1000, 40, true), noise(900, 800);
    for (std::size_t i = 0; i < drawing.pixels.size(); ++i)
        if (i % 1000 < 900) drawing.pixels[i] = i % 1000 > 450 && i / 1000 % 7 == 3 ? 0xff102030U : 0xfff4f1eaU;
    std::uint32_t state = 1;
    for (std::uint32_t& pixel : noise.pixels) pixel = 0xff000000U | (state = state * 1664525U + 1013904223U) >> 8;
    for (const render::Image& image : {drawing, noise})
        EXPECT_EQ(decoded(encode_png(image)).rgba, rgba_bytes(image)) << image.width;
}

TEST(Png, DecodesToTheSamePixelsWhereverOneIsNotOpaque) {
    for (std::size_t at : {0, 1, 99, 100, 131, 132, 4950, 9900, 9999})
        for (std::uint32_t other : {0x80402010U, 0xfe000000U, 0x00000000U}) {
            render::Image image(100, 100);
            std::fill(image.pixels.begin(), image.pixels.end(), 0xfff4f1eaU);
            for (std::size_t i = 4000; i < 4700; ++i) image.pixels[i] = 0xff000000U | static_cast<std::uint32_t>(i * i);
            image.pixels[at] = other;
            const Decoded png = decoded(encode_png(image));
            EXPECT_TRUE(png.alpha);
            EXPECT_EQ(png.rgba, rgba_bytes(image)) << at;
        }
}

TEST(Png, CompressesDrawings) {
    render::Image image(1280, 720);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {  // a slanted bar with soft edges
        const std::size_t x = i % 1280, y = i / 1280, into = x + y - std::min(x + y, 2 * y);
        image.pixels[i] =
            0xff000000U | 0x010101U * static_cast<std::uint32_t>(into > 200 && into < 400 ? 40 + y % 5 : 240);
    }
    EXPECT_LT(encode_png(image).size(), 20'000u);  // of 2.8 MB
}

TEST(Png, HasAnAlphaChannelOnlyWhereItIsNeeded) {
    EXPECT_FALSE(decoded(encode_png(pattern(9, 9, true))).alpha);
    EXPECT_TRUE(decoded(encode_png(pattern(9, 9, false))).alpha);
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
    EXPECT_EQ(encode_png(pattern(640, 64, true)), encode_png(pattern(640, 64, true)));
}

}  // namespace
}  // namespace beamcam::output
