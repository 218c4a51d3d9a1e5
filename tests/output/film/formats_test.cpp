#include <cmath>
#include <set>

#include "output/files/atomic_file.hpp"
#include "output/film/palette.hpp"
#include "output/film/pixel_layout.hpp"
#include "tests/output/film/film.hpp"
#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

struct FormatCase {
    const char* ending;
    Codec codec;
    bool transparent;
    const char* decoded;  // ffprobe's codec
    int tolerance;        // of a flat colour after the way there and back
};
void PrintTo(const FormatCase& k, std::ostream* out) {
    *out << name(k.codec) << k.ending << (k.transparent ? " transparent" : "");
}

class Formats : public testing::TestWithParam<FormatCase> {};

VideoOptions options_of(const FormatCase& kind, int width, int height) {
    VideoOptions options;
    options.width = width, options.height = height;
    options.fps = {25, 1};
    options.codec = kind.codec;
    options.transparent = kind.transparent;
    if (kind.codec == Codec::gif) options.palette = {0xff000000, 0xffffffff, 0xffc0392b, 0xff2c3e9f};
    return options;
}

// Left half in one colour, right half in another, or empty where the film is transparent.
render::Image halves(const FormatCase& kind, int width, int height) {
    render::Image image = flat_image(width, height, 0xffc0392b);
    for (int y = 0; y < height; ++y)
        for (int x = width / 2; x < width; ++x)
            image.pixels[static_cast<std::size_t>(y * width + x)] = kind.transparent ? 0u : 0xff2c3e9fu;
    return image;
}

TEST_P(Formats, KeepColoursTimesAndTransparency) {
    const FormatCase kind = GetParam();
    const int width = 96, height = 64;
    Scratch scratch;
    const auto file = scratch / (std::string("a") + kind.ending);
    {
        Film film(file, options_of(kind, width, height));
        for (int i = 0; i < 5; ++i) {
            render::Image image = halves(kind, width, height);
            for (int y = 0; y < 8; ++y)  // something moves
                for (int x = 0; x < 8; ++x) image.pixels[static_cast<std::size_t>(y * width + x + 4 * i)] = 0xffffffff;
            film.write(image);
        }
        film.finish();
    }
    // FFmpeg writes animated WebP but does not read it; its first bytes tell.
    if (kind.codec == Codec::webp) {
        const std::string bytes = read_file(file);
        EXPECT_EQ(bytes.substr(0, 4) + bytes.substr(8, 4), "RIFFWEBP");
        EXPECT_NE(bytes.find("VP8L"), std::string::npos);  // lossless
        EXPECT_NE(bytes.find("ANIM"), std::string::npos);
        std::size_t frames = 0;
        for (std::size_t at = bytes.find("ANMF"); at != std::string::npos; at = bytes.find("ANMF", at + 4)) ++frames;
        EXPECT_EQ(frames, 5u);
        return;
    }
    const std::string seen = probe(file, "-count_frames -show_streams -show_format");
    EXPECT_NE(seen.find(std::string("codec_name=") + kind.decoded), std::string::npos) << seen;
    EXPECT_NE(seen.find("nb_read_frames=5"), std::string::npos) << seen;
    EXPECT_NE(seen.find("r_frame_rate=25/1"), std::string::npos) << seen;
    const std::string decoder = kind.codec == Codec::vp9 ? "-c:v libvpx-vp9 " : "";  // the other one drops alpha
    const std::string rgba = output_of("/usr/bin/ffmpeg -v error " + decoder + "-i " + file.string() +
                                       " -sws_flags accurate_rnd+full_chroma_int+bitexact -f rawvideo -pix_fmt rgba -");
    ASSERT_EQ(rgba.size(), static_cast<std::size_t>(5 * width * height * 4));
    const auto pixel = [&](int frame, int x, int y, int channel) {
        return static_cast<int>(static_cast<unsigned char>(
            rgba[static_cast<std::size_t>(((frame * height + y) * width + x) * 4 + channel)]));
    };
    const int left[] = {0xc0, 0x39, 0x2b, 255}, right[] = {0x2c, 0x3e, 0x9f, 255};
    for (int frame = 0; frame < 5; ++frame) {
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(pixel(frame, 20, 40, c), left[c], kind.tolerance) << frame << c;
        if (kind.transparent)
            EXPECT_LE(pixel(frame, 80, 40, 3), kind.tolerance);
        else
            for (int c = 0; c < 4; ++c) EXPECT_NEAR(pixel(frame, 80, 40, c), right[c], kind.tolerance) << frame << c;
    }
}

TEST_P(Formats, TheSamePicturesGiveTheSameBytes) {
    const FormatCase kind = GetParam();
    Scratch scratch;
    for (const char* each : {"a", "b"}) {
        Film film(scratch / (each + std::string(kind.ending)), options_of(kind, 96, 64));
        for (int i = 0; i < 3; ++i) film.write(halves(kind, 96, 64));
        film.finish();
    }
    EXPECT_EQ(read_file(scratch / ("a" + std::string(kind.ending))),
              read_file(scratch / ("b" + std::string(kind.ending))));
}

INSTANTIATE_TEST_SUITE_P(
    All, Formats,
    testing::Values(FormatCase{".mp4", Codec::h264, false, "h264", 3}, FormatCase{".webm", Codec::vp9, false, "vp9", 3},
                    FormatCase{".webm", Codec::vp9, true, "vp9", 3},
                    FormatCase{".mov", Codec::prores, false, "prores", 3},
                    FormatCase{".mov", Codec::prores, true, "prores", 3},
                    FormatCase{".mkv", Codec::ffv1, false, "ffv1", 0}, FormatCase{".mkv", Codec::ffv1, true, "ffv1", 0},
                    FormatCase{".gif", Codec::gif, false, "gif", 0}, FormatCase{".webp", Codec::webp, false, "webp", 0},
                    FormatCase{".webp", Codec::webp, true, "webp", 0}));

TEST(FormatProblems, AnImpossibleCombinationNamesAnother) {
    EXPECT_NE(format_problem(".mp4", Codec::h264, true).find(".webm (vp9)"), std::string::npos);
    EXPECT_NE(format_problem(".gif", Codec::gif, true).find(".webp"), std::string::npos);
    EXPECT_NE(format_problem(".webm", Codec::h264, false).find(".mp4"), std::string::npos);
    EXPECT_NE(format_problem(".avi", Codec::h264, false).find(".mp4"), std::string::npos);
    EXPECT_EQ(format_problem(".mov", Codec::prores, true), "");
    EXPECT_NE(size_problem(Codec::vp9, 101, 50).find("102x50"), std::string::npos);
    EXPECT_NE(size_problem(Codec::h264, 1919, 1081).find("use 1920x1082"), std::string::npos);
    EXPECT_EQ(size_problem(Codec::gif, 101, 51), "");
    EXPECT_NE(size_problem(Codec::h264, 16384, 16384).find("16250x16250"), std::string::npos);
    EXPECT_EQ(size_problem(Codec::h264, 16256, 16254), "");
    EXPECT_NE(size_problem(Codec::webp, 16384, 64).find("16383"), std::string::npos);
    EXPECT_EQ(size_problem(Codec::webp, 16383, 64), "");
    EXPECT_NE(rate_problem(Codec::gif, 60).find("50"), std::string::npos);
    EXPECT_EQ(rate_problem(Codec::webp, 60), "");
}

TEST(Palette, KeepsFlatColoursExactly) {
    render::Image image = flat_image(64, 64, 0xfffcfcfa);
    for (int i = 0; i < 400; ++i) image.pixels[static_cast<std::size_t>(i)] = 0xffd55e00;
    for (int i = 400; i < 800; ++i) image.pixels[static_cast<std::size_t>(i)] = 0xff0072b2;
    PaletteMaker maker;
    maker.add(image);
    const auto colors = maker.colors();
    const std::set<std::uint32_t> all(colors.begin(), colors.end());
    for (std::uint32_t c : {0xfffcfcfau, 0xffd55e00u, 0xff0072b2u}) EXPECT_TRUE(all.contains(c)) << std::hex << c;
    std::vector<std::uint8_t> indices(64 * 64);
    PaletteTable(colors).convert(image, indices.data(), 64, all_tiles(image));
    for (std::size_t i : {0u, 500u, 2000u}) EXPECT_EQ(colors[indices[i]], image.pixels[i]);
}

TEST(Palette, HasAtMost256ColoursAndIsNearEveryPixelOfARamp) {
    render::Image image(256, 256);
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x)
            image.pixels[static_cast<std::size_t>(y * 256 + x)] =
                0xff000000u | static_cast<unsigned>(x) << 16 | static_cast<unsigned>(y) << 8 | 0x80u;
    PaletteMaker maker;
    maker.add(image);
    const auto colors = maker.colors();
    EXPECT_LE(colors.size(), 256u);
    EXPECT_GT(colors.size(), 200u);
    std::vector<std::uint8_t> indices(256 * 256);
    PaletteTable(colors).convert(image, indices.data(), 256, all_tiles(image));
    // 256 colours on a plane of 256² leave squares of 16: half of that, and a cell's rounding.
    for (std::size_t i = 0; i < indices.size(); ++i)
        for (int shift : {8, 16})
            ASSERT_NEAR(int(colors[indices[i]] >> shift & 255), int(image.pixels[i] >> shift & 255), 20) << i;
}

// Luma of white and black, chroma of grey, alpha as it is.
TEST(Yuva, TenBitsAreFourTimesTheLevelsOfEight) {
    render::Image image(2, 2);
    image.pixels = {0xffffffff, 0xff000000, 0xff808080, 0x80404040};
    std::vector<std::uint16_t> planes[4];
    FramePlanes to;
    for (std::size_t i = 0; i < 4; ++i) {
        planes[i].resize(4);
        to.plane[i] = reinterpret_cast<std::uint8_t*>(planes[i].data());
        to.stride[i] = 4;
    }
    convert(image, PixelLayout::yuva444p10, nullptr, to, all_tiles(image));
    EXPECT_EQ(planes[0][0], 940);
    EXPECT_EQ(planes[0][1], 64);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(planes[1][i], 512);
        EXPECT_EQ(planes[2][i], 512);
    }
    EXPECT_NEAR(planes[0][3], planes[0][2], 4);  // half-transparent, the same grey
    EXPECT_EQ(planes[3][0], 1023);
    EXPECT_NEAR(planes[3][3], 514, 1);
}

}  // namespace
}  // namespace beamcam::output
