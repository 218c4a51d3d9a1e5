// What the cache changes when the program runs: durations in plans, and not one pixel.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "sim/observe/channels.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished, testing::Folder, testing::shell;
using ::testing::HasSubstr, ::testing::Not;

TEST(Cache, GivesPlansTheDurationsOfEarlierRuns) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.3}, "outputs": [{"type": "trajectory", "file": "t.csv"}]})");
    EXPECT_THAT(shell(folder, "$BEAMCAM plan s.json").out, Not(HasSubstr("about")));
    shell(folder, "$BEAMCAM run -q s.json; rm t.csv");
    const std::string text = shell(folder, "$BEAMCAM plan s.json").out;
    EXPECT_THAT(text, HasSubstr(" steps\n"));
    EXPECT_THAT(text, HasSubstr(fmt::format("rows of {} channels; about ", sim::all_channels({}).size())));
    EXPECT_THAT(text, HasSubstr("estimated from earlier runs"));
    EXPECT_THAT(shell(folder, "$BEAMCAM plan s.json --json").out, HasSubstr("\"seconds\":"));
    EXPECT_THAT(shell(folder, "$BEAMCAM plan s.json --no-cache").out, Not(HasSubstr("about")));
}

TEST(Cache, APlanSaysWhichCostDependsOnEvents) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.5}, "outputs": [{"type": "still", "file": "a.png", "at": "impact:1",
        "size": [64, 64], "view": {"style": "flat"}}, {"type": "trajectory", "file": "t.csv"}]})");
    ASSERT_EQ(shell(folder, "$BEAMCAM run -q s.json").code, 0);
    EXPECT_THAT(shell(folder, "$BEAMCAM plan s.json --force").out,
                HasSubstr("a.png (at events, which are found first)"));
}

// The start of drawing is most of the time of a single frame.
TEST(Cache, AFewFramesDoNotEstimateAFilm) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.5}, "outputs": [{"type": "frames", "file": "f-##.png",
        "size": [64, 64], "view": {"style": "flat"}}]})");
    const std::string part = "$BEAMCAM render -q s.json -o f-##.png --frames ";
    ASSERT_EQ(shell(folder, part + "0:1").code, 0);
    EXPECT_THAT(shell(folder, "$BEAMCAM plan s.json").out,
                HasSubstr("estimated from earlier runs; not known: f-##.png\n"));
    ASSERT_EQ(shell(folder, part + "0:20").code, 0);
    EXPECT_THAT(shell(folder, "$BEAMCAM plan s.json").out, HasSubstr("estimated from earlier runs\n"));
}

TEST(Cache, LeavesPixelsOfFilmsUnchanged) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 1.5}, "outputs": [{"type": "trajectory", "file": "m.csv", "rate": 50},
        {"type": "frames", "file": "f-###.png", "size": [480, 270], "fps": 12, "from": 0.2, "to": 0.5, "view": {"style": "flat", "tip_path": "whole"},
        "speed": {"around": "impacts", "factor": 0.02, "ease": "5 ms"},
        "layout": {"columns": ["mechanism", {"rows": [{"panel": "contact_force", "window": "collision"}, "close-up"]}, "phase"]}}]})");
    std::string pictures;
    const auto made = [&](const char* how, const char* count) {
        const Finished run =
            shell(folder, std::string("rm -f f-*.png m.csv .beamcam.jsonl; $BEAMCAM run s.json -v ") + how);
        ASSERT_EQ(run.code, 0) << run.err;
        EXPECT_THAT(run.err, HasSubstr(count)) << how;
        const std::string found = shell(folder, "picture_hash f-*.png").out;
        EXPECT_GT(std::ranges::count(found, '\n'), 8);
        EXPECT_TRUE(pictures.empty() || found == pictures) << how;
        pictures = found;
    };
    made("--no-cache", "integrations=1 ");
    made("", "integrations=1 ");  // kept
    made("", "integrations=0 ");  // read back
}

}  // namespace
}  // namespace beamcam::scenes
