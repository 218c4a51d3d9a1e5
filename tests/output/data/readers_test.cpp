// Reading back what was written, and refusing what is damaged. FFmpeg's program and numpy are the witnesses.
#include <libdeflate.h>

#include <cmath>
#include <fstream>

#include "output/data/tables.hpp"
#include "output/files/atomic_file.hpp"
#include "output/files/inflate.hpp"
#include "output/film/picture_source.hpp"
#include "output/film/video.hpp"
#include "output/film/video_reader.hpp"
#include "output/image/picture_files.hpp"
#include "output/image/png.hpp"
#include "output/image/png_reader.hpp"
#include "output/image/raster.hpp"
#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

std::string in_shell(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

// One digest a picture, as FFmpeg's own program takes them.
std::vector<std::string> framehash(const std::filesystem::path& file, const std::string& decoder = "") {
    const std::string text = output_of(
        "ffmpeg -v error " + decoder + " -i " + in_shell(file) +
        " -sws_flags bicubic+accurate_rnd+full_chroma_int+bitexact -pix_fmt rgba -f framehash -hash sha256 -");
    std::vector<std::string> digests;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (!line.starts_with('#')) digests.push_back(line.substr(line.rfind(' ') + 1));
    return digests;
}

std::vector<std::string> own_digests(const std::filesystem::path& file) {
    PictureSource source(file);
    std::vector<std::string> digests;
    Raster picture;
    std::string name;
    while (source.next(picture, name)) digests.push_back(digest(picture));
    return digests;
}

// The message of the IoError that `body` ends with.
template <typename Body>
std::string io_error_of(Body body) {
    try {
        body();
    } catch (const IoError& error) {
        return error.what();
    }
    ADD_FAILURE() << "no IoError";
    return {};
}

void make_film(const std::filesystem::path& file, Codec codec = Codec::h264) {
    VideoOptions options;
    options.codec = codec;
    options.width = 64;
    options.height = 48;
    options.preset = "ultrafast";
    options.metadata = {{"beamcam-scene", "{}"}};
    VideoWriter film(file, options);
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
    for (const char* format : {"gray", "gray16be", "rgb24", "rgb48be", "rgba", "rgba64be", "pal8", "ya8", "monob"}) {
        const auto file = scratch / (std::string(format) + ".png");
        output_of("ffmpeg -v error -f lavfi -i testsrc2=s=64x48 -frames:v 1 -pix_fmt " + std::string(format) + " " +
                  in_shell(file));
        EXPECT_EQ(own_digests(file), framehash(file)) << format;
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

TEST(VideoReader, DigestsOfFilmsAreFFmpegs) {
    Scratch scratch;
    make_film(scratch / "a.mp4");
    EXPECT_EQ(own_digests(scratch / "a.mp4").size(), 40u);
    EXPECT_EQ(own_digests(scratch / "a.mp4"), framehash(scratch / "a.mp4"));
    const std::pair<const char*, const char*> others[] = {{"a.webm", "-c:v libvpx-vp9 -deadline realtime"},
                                                          {"a.gif", ""},
                                                          {"a.apng", "-f apng"},
                                                          {"a.mkv", "-c:v ffv1 -pix_fmt bgr0"},
                                                          {"a.mov", "-c:v prores_ks -pix_fmt yuva444p10le"}};
    for (const auto& [name, options] : others) {
        output_of("ffmpeg -v error -i " + in_shell(scratch / "a.mp4") + " -frames:v 6 " + options + " " +
                  in_shell(scratch / name));
        const std::vector<std::string> expected = framehash(scratch / name);
        EXPECT_GE(expected.size(), 5u) << name;
        EXPECT_EQ(own_digests(scratch / name), expected) << name;
    }
}

// WebM stores alpha as a second stream of pictures, which only libvpx decodes.
TEST(VideoReader, TransparentWebmKeepsItsAlpha) {
    Scratch scratch;
    make_film(scratch / "a.mkv");
    output_of("ffmpeg -v error -i " + in_shell(scratch / "a.mkv") +
              " -frames:v 6 -vf format=rgba,colorchannelmixer=aa=0.5 -c:v libvpx-vp9 -pix_fmt yuva420p " +
              in_shell(scratch / "a.webm"));
    EXPECT_EQ(own_digests(scratch / "a.webm"), framehash(scratch / "a.webm", "-c:v libvpx-vp9"));
    VideoReader film(scratch / "a.webm");
    Raster picture;
    ASSERT_TRUE(film.next(picture));
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) ASSERT_NEAR(picture.rgba[i], 128, 2) << i;
}

TEST(VideoReader, KnowsWhatTheFileSaysOfItself) {
    Scratch scratch;
    make_film(scratch / "a.mp4");
    const VideoReader film(scratch / "a.mp4");
    EXPECT_EQ(film.info().frames, 40);
    EXPECT_EQ(film.info().codec, "h264");
    EXPECT_EQ(film.info().metadata.at("beamcam-scene"), "{}");
}

TEST(VideoReader, AFilmThatEndsEarlyOrIsDamagedIsAnError) {
    Scratch scratch;
    make_film(scratch / "a.mp4");
    const std::string whole = read_file(scratch / "a.mp4");
    for (const double share : {0.0, 0.01, 0.3, 0.6, 0.9, 0.999}) {
        write_file(scratch / "cut.mp4", whole.substr(0, static_cast<std::size_t>(share * double(whole.size()))));
        EXPECT_NE(io_error_of([&] { own_digests(scratch / "cut.mp4"); }).find("cut.mp4"), std::string::npos) << share;
    }
    write_file(scratch / "text.mp4", "#EXTM3U\nhttp://127.0.0.1:9/a.ts\n");
    EXPECT_NE(io_error_of([&] { own_digests(scratch / "text.mp4"); }).find("text.mp4"), std::string::npos);
}

// FFmpeg takes the end of a cut Matroska file for the end of the film.
TEST(VideoReader, ACutMatroskaFilmIsAnErrorWhereverItEnds) {
    Scratch scratch;
    make_film(scratch / "a.mkv");
    make_film(scratch / "a.webm", Codec::vp9);
    for (const char* ending : {".mkv", ".webm"}) {
        const std::string whole = read_file(scratch / (std::string("a") + ending));
        EXPECT_EQ(own_digests(scratch / (std::string("a") + ending)).size(), 40U);
        for (const double share : {0.01, 0.1, 0.3, 0.6, 0.9, 0.99, 0.9999}) {
            const auto cut = scratch / (std::string("cut") + ending);
            write_file(cut, whole.substr(0, static_cast<std::size_t>(share * double(whole.size()))));
            EXPECT_NE(io_error_of([&] { own_digests(cut); }).find("cut"), std::string::npos) << ending << share;
        }
    }
}

TEST(VideoReader, ReadsNoOtherFile) {
    Scratch scratch;
    make_film(scratch / "a.mkv");
    output_of("ffmpeg -v error -i " + in_shell(scratch / "a.mkv") + " -frames:v 1 " + in_shell(scratch / "film-1.jpg"));
    EXPECT_EQ(own_digests(scratch / "film-1.jpg").size(), 1U);
    const std::string name = (scratch / "a.mkv").string();
    for (const std::string& script :
         {"ffconcat version 1.0\nfile '" + name + "'\n", "#EXTM3U\n#EXTINF:1,\n" + name + "\n#EXT-X-ENDLIST\n"}) {
        write_file(scratch / "script.mkv", script);
        EXPECT_NE(io_error_of([&] { own_digests(scratch / "script.mkv"); }), "");
        EXPECT_NE(io_error_of([&] { concatenate({scratch / "script.mkv"}, scratch / "joined.mkv"); }), "");
        EXPECT_FALSE(std::filesystem::exists(scratch / "joined.mkv"));
    }
    EXPECT_NE(io_error_of([&] { VideoReader(scratch / "film-%d.jpg"); }), "");
}

TEST(Inflater, GivesOutNoMoreThanItsBudget) {
    std::string packed(200, '\0');
    const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> deflate(
        libdeflate_alloc_compressor(6), libdeflate_free_compressor);
    const std::string zeros(60000, '\0');
    packed.resize(libdeflate_zlib_compress(deflate.get(), zeros.data(), zeros.size(), packed.data(), packed.size()));
    Inflater inflater(100000);
    EXPECT_EQ(inflater.zlib(packed), zeros);
    EXPECT_EQ(inflater.zlib(packed), std::nullopt);
    EXPECT_EQ(Inflater(100000).deflate(packed, 99999999), std::nullopt);
}

TEST(TableReader, ArraysThatShareTheirBytesAreRefused) {
    Scratch scratch;
    const std::string command =
        "cd '" + scratch.path().string() +
        "' && /usr/bin/python3 -c \"import numpy; numpy.savez_compressed('a.npz', t=numpy.zeros(3))\"";
    output_of(command);
    const std::string whole = read_file(scratch / "a.npz");
    ASSERT_EQ(read_table(scratch / "a.npz").rows(), 3U);
    const std::size_t end = whole.rfind("PK\5\6"), begin = whole.rfind("PK\1\2");
    std::string shared = whole.substr(0, end), second = whole.substr(begin, end - begin), tail = whole.substr(end);
    for (char name = 'a'; name < 'k'; ++name) {
        second[46] = name;
        shared += second;
    }
    tail[8] = tail[10] = 11;
    write_file(scratch / "b.npz", shared + tail);
    EXPECT_NE(io_error_of([&] { read_table(scratch / "b.npz"); }).find("damaged"), std::string::npos);
}

TEST(PictureFiles, AreThoseOfADirectoryOrSequenceInTheOrderOfTheirNumbers) {
    Scratch scratch;
    std::vector<std::filesystem::path> expected;
    for (const int k : {9, 10, 100}) {
        expected.push_back(scratch / ("f-" + std::to_string(k) + ".png"));
        write_png(expected.back(), flat_image(4, 4, 0xff000000u + static_cast<std::uint32_t>(k)));
    }
    write_file(scratch / "notes.txt", "no picture");
    EXPECT_EQ(picture_files(scratch.path()), expected);
    EXPECT_EQ(picture_files(scratch / "f-#.png"), expected);
    EXPECT_EQ(picture_files(expected[1]), std::vector{expected[1]});
    for (const char* none : {"g-#.png", "absent.png", "notes.txt"})
        EXPECT_NE(io_error_of([&] { picture_files(scratch / none); }).find(none), std::string::npos);
}

// ---- tables --------------------------------------------------------------------------------------

sim::Table small_table() {
    using sim::ChannelKind;
    return {{{ChannelKind::t, 0}, {ChannelKind::theta, 0}, {ChannelKind::gap, 0}},
            {{0, 0.1, 1.0 / 3}, {1, -2e-300, 3}, {NAN, 5e-324, 1.7976931348623157e308}}};
}

TEST(TableReader, BothFormatsGiveTheSameBitsBack) {
    Scratch scratch;
    const sim::Table table = small_table();
    for (const char* name : {"a.csv", "a.npz"}) {
        write_table(scratch / name, table);
        const ColumnTable read = read_table(scratch / name);
        EXPECT_EQ(read.names(), (std::vector<std::string>{"t", "theta", "gap"}));
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t r = 0; r < 3; ++r)
                if (std::isnan(table.values[c][r]))
                    EXPECT_TRUE(std::isnan(read.columns[c].values[r]));
                else
                    EXPECT_EQ(read.columns[c].values[r], table.values[c][r]) << name << " " << c << " " << r;
    }
}

TEST(TableReader, ReadsWhatNumpyAndSpreadsheetsWrite) {
    Scratch scratch;
    output_of(
        "cd " + in_shell(scratch.path()) +
        " && /usr/bin/python3 -c \"import numpy as n; n.savez_compressed('a.npz', t=n.arange(3.), k=n.arange(3)); "
        "n.savetxt('a.csv', n.ones((2, 2)), header='t,x', delimiter=',')\"");
    const ColumnTable npz = read_table(scratch / "a.npz"), csv = read_table(scratch / "a.csv");
    EXPECT_EQ(*npz.find("k"), (std::vector<double>{0, 1, 2}));
    EXPECT_EQ(*csv.find("x"), (std::vector<double>{1, 1}));
    // Quotes carry no meaning (RFC 4180), but for commas and line breaks within them; lines of the file are counted.
    const ColumnTable quoted = parse_csv("a,note\n\"2\",\"one\ntwo, \"\"three\"\"\"\n3,4\n", "q.csv", Texts::kept);
    EXPECT_EQ(quoted.columns[0].values, (std::vector<double>{2, 3}));
    EXPECT_EQ(quoted.columns[1].text(0), "one\ntwo, \"three\"");
    EXPECT_THAT(io_error_of([] { parse_csv("a,b\n1,\"2\n\"\nx,1\n", "q.csv", Texts::rejected); }),
                ::testing::StartsWith("q.csv:2:3: "));
    EXPECT_THAT(io_error_of([] { parse_csv("a,\"b\nc\"\nx,1\n", "q.csv"); }), ::testing::StartsWith("q.csv:3:1: "));
    EXPECT_THAT(io_error_of([] { parse_csv("a,\"b\nc\",5\n1,2,3\n", "q.csv"); }), ::testing::StartsWith("q.csv:2:4: "));
    EXPECT_THAT(io_error_of([] { parse_csv("a,note,b\n1,\"one\ntwo\",inf\n", "q.csv", Texts::kept); }),
                ::testing::StartsWith("q.csv:3:6: "));
    const ColumnTable excel = parse_csv("\xEF\xBB\xBF\"t\", x\r\n1,+2\r\n3,\r\n", "e.csv");
    EXPECT_EQ(*excel.find("t"), (std::vector<double>{1, 3}));
    EXPECT_EQ(excel.find("x")->front(), 2);
    EXPECT_TRUE(std::isnan(excel.find("x")->back()));
}

// A class by its number, and an exponent of −∞.
TEST(TableReader, ReadsTheTablesOfSweeps) {
    const ColumnTable table =
        parse_csv("cam.speed,class,exponent\n1,following,-inf\n2,periodic,-3\n3,rest,\n", "r.csv");
    EXPECT_EQ(*table.find("class"), (std::vector<double>{1, 2, 0}));
    EXPECT_EQ((*table.find("exponent"))[0], -std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan((*table.find("exponent"))[2]));
}

TEST(TableReader, SaysWhereACsvIsWrong) {
    const auto error = [](const std::string& text) { return io_error_of([&] { parse_csv(text, "a.csv"); }); };
    EXPECT_EQ(error("t,x\n1,2\n3,abc\n"), "a.csv:3:3: \"abc\" is not a number");
    EXPECT_NE(error("t,x\n1,2\n3\n").find("a.csv:3:1: 1 cells"), std::string::npos);
    EXPECT_NE(error("t,x\n1,2\n3, -inf\n").find("a.csv:3:3: \"-inf\" is not a finite number"), std::string::npos);
    EXPECT_NE(error("").find("empty"), std::string::npos);
    EXPECT_NE(error("t,t\n").find("twice"), std::string::npos);
    EXPECT_NE(error("1,2\n").find("name"), std::string::npos);
    EXPECT_NE(error("t;x\n0,5;2\n").find("a.csv:1:2: columns are separated by semicolons"), std::string::npos);
    EXPECT_NE(error("t\tx\n1\t2\n").find("by tabs"), std::string::npos);
}

TEST(TableReader, EveryCutOfAnArchiveIsRefused) {
    Scratch scratch;
    write_table(scratch / "a.npz", small_table());
    const std::string whole = read_file(scratch / "a.npz");
    for (std::size_t size = 0; size < whole.size(); size += 5) {
        write_file(scratch / "cut.npz", whole.substr(0, size), Durability::buffered);
        EXPECT_NE(io_error_of([&] { read_table(scratch / "cut.npz"); }).find("cut.npz"), std::string::npos) << size;
    }
    for (std::size_t at = 0; at < whole.size(); at += 3) {  // never a crash; an unread byte may change nothing
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0xff);
        write_file(scratch / "bad.npz", damaged, Durability::buffered);
        try {
            EXPECT_EQ(read_table(scratch / "bad.npz").rows(), 3u) << at;
        } catch (const IoError&) {
        }
    }
}

}  // namespace
}  // namespace beamcam::output
