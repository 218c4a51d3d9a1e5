#include <signal.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <numeric>
#include <system_error>
#include <thread>

#include "output/files/atomic_file.hpp"
#include "output/files/digest.hpp"
#include "output/film/video_library.hpp"
#include "tests/output/film/film.hpp"
#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

VideoOptions small_film() {
    VideoOptions options;
    options.width = 64;
    options.height = 48;
    options.preset = "ultrafast";
    return options;
}

render::Image moving_square(int width, int height, int frame) {
    render::Image image = flat_image(width, height, 0xfff4f1ea);
    for (int y = 8; y < 24; ++y)
        for (int x = 0; x < 16; ++x)
            image.pixels[static_cast<std::size_t>(y * width + (x + 2 * frame) % width)] = 0xff1f4e8c;
    return image;
}

void write_film(const std::filesystem::path& file, const VideoOptions& options, int frames) {
    Film film(file, options);
    for (int i = 0; i < frames; ++i) film.write(moving_square(options.width, options.height, i));
    film.finish();
}

// R, G, B of the top-left pixel of every frame, as FFmpeg shows them; after `filters`, each with a comma.
std::string first_pixels(const std::filesystem::path& file, const std::string& filters = {}) {
    return output_of("/usr/bin/ffmpeg -v error -i " + file.string() + " -vf " + filters +
                     "crop=1:1:0:0:exact=1 -sws_flags accurate_rnd+full_chroma_int -f rawvideo -pix_fmt rgb24 -");
}

TEST(Film, IsWhatPlayersExpect) {
    Scratch scratch;
    VideoOptions options;
    options.metadata = {{"title", "Fall on a cam, θ₀ = 45°"}, {"beamcam_scene", "{\"hub\":{}}"}};
    write_film(scratch / "a.mp4", options, 5);
    const std::string seen = probe(scratch / "a.mp4", "-count_frames -show_streams -show_format");
    for (const char* expected :
         {"codec_name=h264", "width=1920", "height=1080", "pix_fmt=yuv420p", "color_range=tv", "color_space=bt709",
          "color_transfer=bt709", "color_primaries=bt709", "chroma_location=center", "r_frame_rate=60/1",
          "avg_frame_rate=60/1", "nb_read_frames=5", "nb_frames=5", "sample_aspect_ratio=1:1", "duration=0.083333",
          "TAG:title=Fall on a cam, θ₀ = 45°", "TAG:beamcam_scene={\"hub\":{}}"})
        EXPECT_NE(seen.find(expected), std::string::npos) << expected << "\n" << seen;
}

TEST(Film, HasItsIndexFirst) {
    Scratch scratch;
    write_film(scratch / "a.mp4", small_film(), 5);
    const std::string bytes = read_file(scratch / "a.mp4");
    ASSERT_NE(bytes.find("moov"), std::string::npos);
    EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
}

TEST(Film, ShowsFlatColoursWithinTwoLevels) {
    for (const std::uint32_t colour :
         {0xff000000u, 0xffffffffu, 0xff808080u, 0xffc0392bu, 0xff27ae60u, 0xff2c3e9fu, 0xfff4f1eau}) {
        Scratch scratch;
        Film film(scratch / "a.mp4", small_film());
        for (int i = 0; i < 3; ++i) film.write(flat_image(64, 48, colour));
        film.finish();
        const std::string rgb = first_pixels(scratch / "a.mp4");
        ASSERT_EQ(rgb.size(), 9u);
        for (std::size_t i = 0; i < 9; ++i) {
            const int expected = static_cast<int>(colour >> (16 - 8 * (i % 3)) & 0xff);
            EXPECT_NEAR(static_cast<unsigned char>(rgb[i]), expected, 2) << std::hex << colour << " byte " << i;
        }
    }
}

TEST(Film, KeepsItsFramesInOrder) {
    Scratch scratch;
    Film film(scratch / "a.mp4", small_film());
    for (unsigned i = 0; i < 20; ++i) film.write(flat_image(64, 48, 0xff000000u | (i * 12) * 0x010101u));
    film.finish();
    const std::string rgb = first_pixels(scratch / "a.mp4");
    ASSERT_EQ(rgb.size(), 60u);
    for (unsigned i = 0; i < 20; ++i) EXPECT_NEAR(static_cast<unsigned char>(rgb[3 * i]), 12.0 * i, 2) << i;
}

TEST(Film, ARepeatedPictureIsTheSameAsOneWrittenAgain) {
    Scratch scratch;
    write_film(scratch / "written.mp4", small_film(), 1);
    {
        Film written(scratch / "written.mp4", small_film()), repeated(scratch / "repeated.mp4", small_film());
        for (int i = 0; i < 3; ++i) {
            written.write(moving_square(64, 48, i));
            repeated.write(moving_square(64, 48, i));
            for (int k = 0; k < 20; ++k) {
                written.write(moving_square(64, 48, i));
                repeated.repeat();
            }
        }
        written.finish();
        repeated.finish();
        EXPECT_EQ(repeated.statistics().frames, 63);
    }
    EXPECT_EQ(sha256_of_file(scratch / "written.mp4"), sha256_of_file(scratch / "repeated.mp4"));
}

// Eight pictures' time of the first, one of the second, 151 of the third, which is more than may be held, five of the
// last.
TEST(Film, AVariableRateShowsTheSameAndCodesWhatIsHeldOnce) {
    struct Kind {
        const char* ending;
        Codec codec;
    };
    constexpr std::array<std::uint32_t, 4> kColours{0xff000000, 0xffc0392b, 0xff2c3e9f, 0xffffffff};
    constexpr std::array kTimes{8, 1, 151, 5};
    for (const Kind& kind : {Kind{".mp4", Codec::h264}, Kind{".mov", Codec::prores}, Kind{".webm", Codec::vp9},
                             Kind{".mkv", Codec::ffv1}, Kind{".gif", Codec::gif}}) {
        Scratch scratch;
        VideoOptions options = small_film();
        options.height = 64;
        options.fps = {20, 1};
        options.codec = kind.codec;
        options.variable_rate = true;
        if (kind.codec == Codec::gif) options.palette = {kColours.begin(), kColours.end()};
        const std::filesystem::path file = (scratch / "f").string() + kind.ending;
        Film film(file, options);
        for (std::size_t i = 0; i < kColours.size(); ++i) {
            film.write(flat_image(64, 64, kColours[i]));
            for (int k = 1; k < kTimes[i]; ++k) film.repeat();
        }
        film.finish();
        // The four, one after five seconds, and the last at the film's end.
        EXPECT_EQ(film.statistics().frames, 6) << kind.ending;
        EXPECT_EQ(film.statistics().held, 159) << kind.ending;
        EXPECT_NE(probe(file, "-count_frames -show_streams").find("nb_read_frames=6\n"), std::string::npos)
            << kind.ending;
        EXPECT_EQ(probe(file, "-show_entries format=duration"), "duration=8.250000\n") << kind.ending;
        const std::string rgb = first_pixels(file, "fps=20,");
        ASSERT_EQ(rgb.size(), 3U * 165) << kind.ending;
        std::size_t at = 0;
        for (std::size_t i = 0; i < kColours.size(); ++i)
            for (int k = 0; k < kTimes[i]; ++k, at += 3)
                for (std::size_t c = 0; c < 3; ++c)
                    EXPECT_NEAR(static_cast<unsigned char>(rgb[at + c]),
                                static_cast<int>(kColours[i] >> (16 - 8 * c) & 0xff), 4)
                        << kind.ending << " frame " << at / 3;
    }
}

// The durations of the pictures of an animated WebP [ms]: the fourth 24-bit number and the two before it of each chunk
// "ANMF".
std::vector<int> webp_durations(const std::string& bytes) {
    const auto number = [&](std::size_t at, int size) {
        unsigned value = 0;
        for (int i = size - 1; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes.at(at + unsigned(i)));
        return value;
    };
    std::vector<int> all;
    for (std::size_t at = 12; at + 8 <= bytes.size(); at += 8 + number(at + 4, 4) + number(at + 4, 4) % 2)
        if (bytes.compare(at, 4, "ANMF") == 0) all.push_back(static_cast<int>(number(at + 8 + 12, 3)));
    return all;
}

// The delays of the pictures of a GIF [1/100 s], in its graphic control extensions.
std::vector<int> gif_delays(const std::string& bytes) {
    std::vector<int> all;
    const std::string extension("\x21\xF9\x04", 3);
    for (std::size_t at = bytes.find(extension); at != std::string::npos; at = bytes.find(extension, at + 1))
        if (bytes.at(at + 7) == 0)
            all.push_back(static_cast<unsigned char>(bytes.at(at + 4)) +
                          256 * static_cast<unsigned char>(bytes.at(at + 5)));
    return all;
}

// Shows each picture `held` times.
void write_held(const std::filesystem::path& file, const VideoOptions& options, const std::vector<int>& held) {
    Film film(file, options);
    for (std::size_t i = 0; i < held.size(); ++i) {
        film.write(moving_square(options.width, options.height, static_cast<int>(i)));
        for (int k = 1; k < held[i]; ++k) film.repeat();
    }
    film.finish();
}

// In these formats the last picture lasts until the film's end, not as long as the one before it or as the mean of the
// others.
TEST(Film, TheDurationsOfPicturesAddUpToTheFilm) {
    const std::vector<std::vector<int>> films{{1, 1, 1, 1}, {1, 1, 200}, {40, 1}, {3, 5, 1, 1, 7}, {300, 2, 120}};
    Scratch scratch;
    for (const double fps : {0.5, 10.0, 15.0, 24.0, 29.97, 30.0, 48.0, 50.0})
        for (const bool variable : {false, true})
            for (const std::vector<int>& held : films) {
                VideoOptions options = small_film();
                options.fps = frame_rate(fps);
                options.variable_rate = variable;
                const double seconds = std::accumulate(held.begin(), held.end(), 0) / options.fps.value();
                const auto sum = [](const std::vector<int>& all) { return std::accumulate(all.begin(), all.end(), 0); };
                options.codec = Codec::webp;
                write_held(scratch / "f.webp", options, held);
                EXPECT_EQ(sum(webp_durations(read_file(scratch / "f.webp"))), std::lround(1000 * seconds))
                    << fps << variable;
                options.codec = Codec::gif;
                options.palette = {0xfff4f1ea, 0xff1f4e8c};
                write_held(scratch / "f.gif", options, held);
                EXPECT_EQ(sum(gif_delays(read_file(scratch / "f.gif"))), std::lround(100 * seconds)) << fps << variable;
            }
}

// The tiles in which two pictures differ, and no more.
render::DirtyTiles changed_tiles(const render::Image& a, const render::Image& b) {
    render::DirtyTiles tiles(a.width, a.height);
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const auto at = static_cast<std::size_t>(y * a.width + x);
            if (a.pixels[at] != b.pixels[at]) tiles.add({x + 0.25, y + 0.25, 0.5, 0.5});
        }
    return tiles;
}

// Two inputs that take turns, as two threads do: whatever the format, the film is that of whole pictures.
TEST(Film, PicturesConvertedWhereTheyChangedGiveTheSameBytes) {
    struct Kind {
        const char* ending;
        Codec codec;
        bool transparent;
    };
    for (const Kind& kind :
         {Kind{".mp4", Codec::h264, false}, Kind{".webm", Codec::vp9, true}, Kind{".mov", Codec::prores, true},
          Kind{".mkv", Codec::ffv1, false}, Kind{".gif", Codec::gif, false}}) {
        Scratch scratch;
        VideoOptions options = small_film();
        options.width = 160;
        options.fps = {50, 1};
        options.codec = kind.codec;
        options.transparent = kind.transparent;
        if (kind.codec == Codec::gif) options.palette = {0xfff4f1ea, 0xff1f4e8c};
        const std::filesystem::path whole = (scratch / "whole").string() + kind.ending,
                                    parts = (scratch / "parts").string() + kind.ending;
        write_film(whole, options, 12);
        Film film(parts, options);
        VideoInput inputs[] = {VideoInput(film), VideoInput(film)};
        render::Image before[] = {render::Image(160, 48), render::Image(160, 48)};
        for (int i = 0; i < 12; ++i) {
            const render::Image picture = moving_square(160, 48, i);
            const render::DirtyTiles changed = changed_tiles(before[i % 2], picture);
            inputs[i % 2].convert(picture, changed);
            inputs[i % 2].send();
            before[i % 2] = picture;
        }
        film.finish();
        EXPECT_EQ(film.statistics().frames, 12);
        EXPECT_EQ(sha256_of_file(whole), sha256_of_file(parts)) << kind.ending;
    }
}

TEST(Film, SamePicturesGiveTheSameBytes) {
    Scratch scratch;
    write_film(scratch / "a.mp4", small_film(), 30);
    write_film(scratch / "b.mp4", small_film(), 30);
    EXPECT_EQ(sha256_of_file(scratch / "a.mp4"), sha256_of_file(scratch / "b.mp4"));
}

TEST(Film, KeepsBroadcastRatesExactly) {
    Scratch scratch;
    VideoOptions options = small_film();
    options.fps = frame_rate(29.97);
    write_film(scratch / "a.mp4", options, 3);
    EXPECT_NE(probe(scratch / "a.mp4", "-show_streams").find("r_frame_rate=30000/1001"), std::string::npos);
}

TEST(Film, MayLastOneFrame) {
    Scratch scratch;
    write_film(scratch / "a.mp4", small_film(), 1);
    EXPECT_NE(probe(scratch / "a.mp4", "-count_frames -show_streams").find("nb_read_frames=1"), std::string::npos);
}

TEST(Film, AcceptsNamesThatLookLikeAddresses) {
    Scratch scratch;
    write_film(scratch / "http:x %d θ.mp4", small_film(), 2);
    EXPECT_EQ(scratch.names(), std::vector<std::string>{"http:x %d θ.mp4"});
}

TEST(Film, LeavesNothingWhenItIsNotFinished) {
    Scratch scratch;
    {
        Film film(scratch / "a.mp4", small_film());
        for (int i = 0; i < 30; ++i) film.write(moving_square(64, 48, i));
    }
    EXPECT_TRUE(scratch.names().empty());
}

TEST(Film, OfAnyCodecEndsWhenItIsDropped) {
    Scratch scratch;
    const std::pair<const char*, Codec> kinds[] = {{"a.webm", Codec::vp9},
                                                   {"a.mov", Codec::prores},
                                                   {"a.mkv", Codec::ffv1},
                                                   {"a.mp4", Codec::h264},
                                                   {"a.webp", Codec::webp}};
    for (const auto& [name, codec] : kinds)
        for (int pictures : {0, 1, 7}) {
            VideoOptions options = small_film();
            options.width = 96, options.height = 64;
            options.codec = codec;
            {
                Film film(scratch / name, options);
                for (int i = 0; i < pictures; ++i) film.write(moving_square(96, 64, i));
            }
            EXPECT_TRUE(scratch.names().empty()) << name << " " << pictures;
        }
}

TEST(Film, WithoutPicturesIsRefused) {
    Scratch scratch;
    Film film(scratch / "a.mp4", small_film());
    EXPECT_THROW(film.finish(), std::logic_error);
    EXPECT_THROW(film.repeat(), std::logic_error);
}

TEST(Film, RefusesAPictureOfAnotherSize) {
    Scratch scratch;
    Film film(scratch / "a.mp4", small_film());
    EXPECT_THROW(film.write(flat_image(66, 48, 0)), std::logic_error);
}

// A limit on the file size stands for the full disk.
TEST(Film, SaysSoAndLeavesNothingWhenTheDiskIsFull) {
    Scratch scratch;
    const int code = exit_code_of([&] {
        install_handlers();
        const rlimit limit = {20000, 20000};
        setrlimit(RLIMIT_FSIZE, &limit);
        VideoOptions options = small_film();
        options.width = 320, options.height = 240, options.crf = 1;
        try {
            Film film(scratch / "a.mp4", options);
            render::Image noise(320, 240);
            for (int frame = 0; frame < 60; ++frame) {
                for (std::size_t i = 0; i < noise.pixels.size(); ++i)
                    noise.pixels[i] =
                        0xff000000u | static_cast<std::uint32_t>((i + 1) * 2654435761u * unsigned(frame + 3));
                film.write(noise);
            }
            film.finish();
        } catch (const IoError& error) {
            return std::string(error.what()).find("a.mp4: File too large") != std::string::npos ? 0 : 1;
        }
        return 2;
    });
    EXPECT_EQ(code, 0);
    EXPECT_TRUE(scratch.names().empty());
}

bool can_start_a_thread() {
    try {
        std::thread([] {}).join();
        return true;
    } catch (const std::system_error&) {
        return false;
    }
}

TEST(Film, WithoutAThreadForTheEncoderSaysSoAndClosesWhatIsOpen) {
    constexpr int kNoLimit = 77;
    const std::pair<const char*, Codec> kinds[] = {
        {"a.mkv", Codec::ffv1}, {"a.mp4", Codec::h264}, {"a.webm", Codec::vp9}, {"a.mov", Codec::prores}};
    for (const auto& [file, codec] : kinds) {
        Scratch scratch;
        std::filesystem::permissions(scratch.path(), std::filesystem::perms::all);
        const int code = exit_code_of([&, name = file, kind = codec] {
            VideoOptions options = small_film();
            options.codec = kind;
            options.height = 64;
            video_library();
            const rlimit one = {1, 1};
            setrlimit(RLIMIT_NPROC, &one);
            if (geteuid() == 0 && setuid(65534) != 0) return kNoLimit;  // root has no limit
            if (can_start_a_thread()) return kNoLimit;
            const std::ptrdiff_t before = open_files();
            for (int times = 0; times < 3; ++times) try {
                    Film film(scratch / name, options);
                    return 1;
                } catch (const IoError& error) {
                    if (std::string(error.what()).find("no thread can be started") == std::string::npos) return 2;
                } catch (const MissingCodec&) {
                }
            return open_files() == before ? 0 : 3;
        });
        if (code == kNoLimit) GTEST_SKIP() << "the number of threads cannot be limited here";
        EXPECT_EQ(code, 0) << file;
        EXPECT_TRUE(scratch.names().empty()) << file;
    }
}

TEST(Film, SecondSignalLeavesNothing) {
    Scratch scratch;
    const int code = exit_code_of([&] {
        signal(SIGINT, SIG_DFL);
        install_handlers();
        Film film(scratch / "a.mp4", small_film());
        for (int i = 0; i < 10; ++i) film.write(moving_square(64, 48, i));
        raise(SIGINT);
        raise(SIGINT);
        return 1;
    });
    EXPECT_EQ(code, 130);
    EXPECT_TRUE(scratch.names().empty());
}

TEST(FrameRate, KnowsTheBroadcastRates) {
    EXPECT_EQ(frame_rate(60), (FrameRate{60, 1}));
    EXPECT_EQ(frame_rate(23.976), (FrameRate{24000, 1001}));
    EXPECT_EQ(frame_rate(23.98), (FrameRate{24000, 1001}));
    EXPECT_EQ(frame_rate(29.97), (FrameRate{30000, 1001}));
    EXPECT_EQ(frame_rate(30000.0 / 1001), (FrameRate{30000, 1001}));
    EXPECT_EQ(frame_rate(59.94), (FrameRate{60000, 1001}));
    EXPECT_EQ(frame_rate(119.88), (FrameRate{120000, 1001}));
}

TEST(FrameRate, OtherRatesAreTheNearestFraction) {
    EXPECT_EQ(frame_rate(12.5), (FrameRate{25, 2}));
    EXPECT_EQ(frame_rate(0.1), (FrameRate{1, 10}));
    EXPECT_EQ(frame_rate(100.0 / 3), (FrameRate{100, 3}));
    EXPECT_EQ(frame_rate(29.5), (FrameRate{59, 2}));
}

}  // namespace
}  // namespace beamcam::output
