// Reading back what was written, and refusing what is damaged. FFmpeg's program and numpy are the witnesses.
#include <libdeflate.h>

#include <cmath>
#include <fstream>

#include "output/files/atomic_file.hpp"
#include "output/film/video_library.hpp"
#include "output/image/png.hpp"
#include "output/image/png_reader.hpp"
#include "output/image/raster.hpp"
#include "tests/output/film/film.hpp"
#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

// The digest of a picture, as FFmpeg's own program takes it.
std::string framehash(const std::filesystem::path& file) {
    const std::string text =
        output_of("ffmpeg -v error -i " + in_shell(file) + " -pix_fmt rgba -f framehash -hash sha256 - | tail -n 1");
    return text.substr(text.rfind(' ') + 1, 64);
}

void make_film(const std::filesystem::path& file, Codec codec = Codec::h264) {
    VideoOptions options;
    options.codec = codec;
    options.width = 64;
    options.height = 48;
    options.preset = "ultrafast";
    options.metadata = {{"beamcam-scene", "{}"}};
    Film film(file, options);
    for (int k = 0; k < 40; ++k) {
        render::Image image = pattern(64, 48, true);
        for (std::uint32_t& pixel : image.pixels)
            pixel = 0xff000000 | (pixel + static_cast<std::uint32_t>(k) * 0x030711);
        film.write(image);
    }
    film.finish();
}

TEST(PngReader, GivesThePixelsThatWereWritten) {
    Scratch scratch;
    for (bool opaque : {true, false}) {
        const render::Image image = pattern(33, 17, opaque);
        write_png(scratch / "a.png", image);
        EXPECT_EQ(digest(read_png(scratch / "a.png")), digest(image));
    }
}

TEST(PngReader, GivesTheMetadataWithoutDecodingPixels) {
    Scratch scratch;
    write_png(scratch / "a.png", pattern(8, 8, true), {std::nullopt, {{"beamcam-scene", "{\"ω\": 1}"}, {"Title", ""}}});
    const auto found = read_png_info(scratch / "a.png").metadata;
    EXPECT_EQ(found.at("beamcam-scene"), "{\"ω\": 1}");
    EXPECT_EQ(found.at("Title"), "");
}

TEST(PngReader, NamesItsLimitOfTexts) {
    Scratch scratch;
    std::map<std::string, std::string> texts;
    for (int k = 0; k < 900; ++k) texts["key " + std::to_string(k)] = "value";
    write_png(scratch / "a.png", pattern(8, 8, true), {std::nullopt, texts});
    EXPECT_EQ(read_png_info(scratch / "a.png").metadata.size(), texts.size());
    for (int k = 0; k < 200; ++k) texts["more " + std::to_string(k)] = "value";
    write_png(scratch / "a.png", pattern(8, 8, true), {std::nullopt, texts});
    EXPECT_NE(io_error_of([&] { read_png(scratch / "a.png"); }).find("more than a thousand"), std::string::npos);
}

TEST(PngReader, DigestsOfEveryKindOfPngAreFFmpegs) {
    Scratch scratch;
    for (const char* format : {"gray", "rgb24", "rgba", "pal8", "ya8", "monob"}) {
        const auto file = scratch / (std::string(format) + ".png");
        output_of("ffmpeg -v error -f lavfi -i testsrc2=s=64x48 -frames:v 1 -pix_fmt " + std::string(format) + " " +
                  in_shell(file));
        EXPECT_EQ(digest(read_png(file)), framehash(file)) << format;
    }
}

TEST(PngReader, EveryCutAndEveryFlippedByteOfThePixelsIsRefusedInWords) {
    Scratch scratch;
    const std::string whole = encode_png(pattern(24, 24, false));
    for (std::size_t size = 0; size < whole.size(); size += 7) {
        write_file(scratch / "cut.png", whole.substr(0, size), Durability::buffered);
        EXPECT_NE(io_error_of([&] { read_png(scratch / "cut.png"); }).find("cut.png"), std::string::npos) << size;
    }
    for (std::size_t size = whole.size() - 16; size < whole.size(); ++size) {  // within the chunk that ends it
        write_file(scratch / "cut.png", whole.substr(0, size), Durability::buffered);
        EXPECT_NE(io_error_of([&] { read_png(scratch / "cut.png"); }).find("cut off"), std::string::npos) << size;
    }
    const std::size_t data = whole.find("IDAT") + 4;
    for (std::size_t at = data; at < whole.size() - 16; at += 11) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
        write_file(scratch / "damaged.png", damaged, Durability::buffered);
        EXPECT_NE(io_error_of([&] { read_png(scratch / "damaged.png"); }).find("damaged"), std::string::npos) << at;
    }
}

std::string png_that_claims(std::uint32_t width, std::uint32_t height) {
    std::string file = encode_png(pattern(1, 1, true));
    for (int i = 0; i < 4; ++i) {
        file[static_cast<std::size_t>(16 + i)] = static_cast<char>(width >> (24 - 8 * i));
        file[static_cast<std::size_t>(20 + i)] = static_cast<char>(height >> (24 - 8 * i));
    }
    const std::uint32_t checksum = libdeflate_crc32(0, file.data() + 12, 17);
    for (int i = 0; i < 4; ++i) file[static_cast<std::size_t>(29 + i)] = static_cast<char>(checksum >> (24 - 8 * i));
    return file;
}

TEST(PngReader, ImpossibleSizesAreRefusedBeforeMemoryIsAskedFor) {
    Scratch scratch;
    write_file(scratch / "empty.png", png_that_claims(0, 0));
    EXPECT_NE(io_error_of([&] { read_png(scratch / "empty.png"); }).find("width"), std::string::npos);
    write_file(scratch / "huge.png", png_that_claims(20000, 20000));
    EXPECT_NE(io_error_of([&] { read_png(scratch / "huge.png"); }).find("20000x20000"), std::string::npos);
    write_file(scratch / "text.png", "not a picture");
    EXPECT_NE(io_error_of([&] { read_png(scratch / "text.png"); }).find("not a PNG"), std::string::npos);
}

TEST(FilmInfo, IsWhatTheFileStates) {
    Scratch scratch;
    for (const auto& [name, codec] :
         {std::pair{"a.mp4", Codec::h264}, {"a.mov", Codec::prores}, {"a.mkv", Codec::ffv1}, {"a.webm", Codec::vp9}}) {
        make_film(scratch / name, codec);
        const VideoInfo info = video_library().info(scratch / name);
        EXPECT_EQ(info.width, 64) << name;
        EXPECT_EQ(info.height, 48) << name;
        EXPECT_EQ(info.codec, output::name(codec)) << name;
        EXPECT_NEAR(info.seconds, 40 / 60.0, 1e-3) << name;
        EXPECT_EQ(info.frames, codec == Codec::h264 || codec == Codec::prores ? 40 : 0)
            << name;  // Matroska has no count
        const bool kept = std::ranges::any_of(info.metadata, [](const auto& tag) { return tag.second == "{}"; });
        EXPECT_TRUE(kept) << name;
    }
}

TEST(FilmInfo, OfAFileThatIsNoFilmIsAnError) {
    Scratch scratch;
    make_film(scratch / "a.mp4");
    const std::string whole = read_file(scratch / "a.mp4");
    for (const std::size_t bytes : {0U, 40U}) {  // its index is near the beginning
        write_file(scratch / "cut.mp4", whole.substr(0, bytes));
        EXPECT_NE(io_error_of([&] { video_library().info(scratch / "cut.mp4"); }).find("cut.mp4"), std::string::npos);
    }
}

// Play lists and scripts name other files.
TEST(FilmInfo, ReadsNoOtherFile) {
    Scratch scratch;
    make_film(scratch / "a.mkv", Codec::ffv1);
    const std::string name = (scratch / "a.mkv").string();
    for (const std::string& script :
         {"ffconcat version 1.0\nfile '" + name + "'\n", "#EXTM3U\n#EXTINF:1,\n" + name + "\n#EXT-X-ENDLIST\n"}) {
        write_file(scratch / "script.mkv", script);
        EXPECT_NE(io_error_of([&] { video_library().info(scratch / "script.mkv"); }), "");
    }
}

}  // namespace
}  // namespace beamcam::output
