// Films of sweeps: what they hold, and what is refused.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished, testing::Folder, testing::shell;
using ::testing::HasSubstr;

constexpr const char* kSwept = R"({
    "beam": {"model": "rigid"}, "contact": {"model": "restitution", "restitution": 0.5},
    "cam": {"eccentricity": "2 mm"}, "initial": {"angle": 0.5},
    "sweep": {"over": [{"key": "cam.speed", "from": 30, "to": 60, "count": 7}], "transient": {"cam_turns": 100},
              "keep": {"cam_turns": 20}, "seed": ["carry-up", "carry-down"]}})";

TEST(SweepFilm, GrowsFromAnEmptyDiagramToTheWholeOne) {
    const Folder folder;
    folder.write("s.json", kSwept);
    const std::string run = R"($BEAMCAM run s.json --set 'outputs=[{"type": "sweep-film", "file": "f.mkv",
        "size": [640, 360], "fps": 10, "duration": 4, "style": "flat"}]')";
    const Finished done = shell(folder, run);
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_THAT(done.err, HasSubstr("wrote ./f.mkv (40 frames)"));
    EXPECT_FALSE(std::filesystem::exists(folder / "f.mkv.part"));
    EXPECT_THAT(shell(folder, run).err, HasSubstr("up to date"));
    EXPECT_THAT(shell(folder, "$BEAMCAM info f.mkv --scene").out, HasSubstr("carry-down"));
    const auto ink = [&](int frame) {  // dark pixels of the diagram, which is the left half
        const Finished raw =
            shell(folder, fmt::format("ffmpeg -v error -i f.mkv -vf 'select=eq(n\\,{}),crop=320:360:0:0' "
                                      "-frames:v 1 -pix_fmt gray -f rawvideo -",
                                      frame));
        EXPECT_EQ(raw.out.size(), 320u * 360u);
        return std::ranges::count_if(raw.out, [](char c) { return static_cast<unsigned char>(c) < 200; });
    };
    const auto first = ink(0), middle = ink(20), last = ink(39);
    EXPECT_LT(first, middle);
    EXPECT_LT(middle, last);
}

// The letters beside the beam are as high as in a film of the whole picture.
TEST(SweepFilm, HasLettersOfTheWholePicture) {
    const Folder folder;
    folder.write("s.json", kSwept);
    const Finished done = shell(folder, R"($BEAMCAM run s.json --set 'outputs=[{"type": "sweep-film", "file": "f.mkv",
        "size": [1280, 720], "fps": 2, "duration": 1, "style": "flat"}]')");
    ASSERT_EQ(done.code, 0) << done.err;
    const Finished raw = shell(folder,
                               "ffmpeg -v error -i f.mkv -vf crop=560:60:720:0 -frames:v 1 -pix_fmt gray "
                               "-f rawvideo -");
    ASSERT_EQ(raw.out.size(), 560u * 60u);
    int rows = 0;  // of the title
    for (std::size_t y = 0; y < 60; ++y)
        rows += std::ranges::any_of(raw.out.substr(560 * y, 560), [](char c) { return std::uint8_t(c) < 128; });
    EXPECT_GE(rows, 0.03 * 720);
}

TEST(SweepFilm, RefusesWhatItCannotShow) {
    const Folder folder;
    const auto judged = [&](const char* scene, const std::string& film) {
        folder.write("s.json", scene);
        return shell(folder, "$BEAMCAM check s.json --set 'outputs=[{\"type\": \"sweep-film\"" + film + "}]'").err;
    };
    EXPECT_THAT(judged("{}", ""), HasSubstr("has no key \"sweep\" over one key"));
    EXPECT_THAT(judged(kSwept, R"(, "size": [200, 100])"), HasSubstr("too small for a diagram beside the beam"));
    EXPECT_THAT(judged(kSwept, R"(, "size": [481, 301])"), HasSubstr("use 482x302"));
    EXPECT_THAT(judged(kSwept, R"(, "file": "f.gif")"), HasSubstr(".mp4"));
    EXPECT_EQ(judged(kSwept, "").find("error"), std::string::npos);
    EXPECT_THAT(judged(kSwept, R"(, "size": [640, 360])"), HasSubstr("is too small to show"));
    EXPECT_EQ(judged(kSwept, "").find("too small"), std::string::npos);
}

TEST(SweepFilm, OfTheCommandIsThatOfTheSceneAndOfOneKey) {
    const Folder folder;
    folder.write("s.json", kSwept);
    const std::string sweep = R"($BEAMCAM sweep s.json -q --film f.mp4 --set 'outputs=[{"type": "sweep-film",
        "size": [640, 360], "fps": 5, "duration": 1, "style": "flat"}]' )";
    const Finished done = shell(folder, sweep);
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(shell(folder,
                    "ffprobe -v error -count_frames -show_entries stream=width,height,nb_read_frames -of csv=p=0 "
                    "f.mp4")
                  .out,
              "640,360,5\n");
    const Finished grid =
        shell(folder, sweep + "--force --over cam.speed=38:60:3 --over contact.restitution=0.2:0.9:3");
    EXPECT_EQ(grid.code, 2);
    EXPECT_THAT(grid.err, HasSubstr("--film: the sweep varies two keys"));
}

}  // namespace
}  // namespace beamcam::scenes
