// What a run that the solver could not finish leaves behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes::testing {
namespace {

TEST(Partial, TableHasTheRowsThatWereReached) {
    const Folder folder;
    const Finished run =
        shell(folder,
              "echo '{\"cam\": {\"radius\": 1e-6, \"eccentricity\": 0}, \"time\": {\"end\": 0.5}}' > s.json;"
              "$BEAMCAM simulate s.json --rate 100 --trajectory motion.csv");
    EXPECT_EQ(run.code, 4);
    EXPECT_THAT(run.err, ::testing::HasSubstr("at t = 0.3699955"));
    EXPECT_FALSE(std::filesystem::exists(folder / "motion.csv"));
    const std::string table = slurp(folder / "motion.partial.csv");
    EXPECT_THAT(table, ::testing::Not(::testing::HasSubstr("\n,")));
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + 37);  // 0 to 0.36 s
}

// Of a rigid beam that the hub presses through the cam.
TEST(Partial, ImpactsAreThoseThatWereFound) {
    const Folder folder;
    folder.write("s.json", R"({"beam": {"model": "rigid"}, "hub": {"drive": {"type": "prescribed", "law": "constant",
        "speed": -1}}, "initial": {"angle": 1}, "time": {"end": 2}})");
    for (const std::string ending : {".json", ".csv"}) {
        const Finished run = shell(folder, "$BEAMCAM simulate s.json --impacts i" + ending);
        EXPECT_EQ(run.code, 4);
        EXPECT_THAT(run.err, ::testing::HasSubstr("wrote i.partial" + ending));
        EXPECT_FALSE(std::filesystem::exists(folder / ("i" + ending)));
    }
    EXPECT_THAT(slurp(folder / "i.partial.json"), ::testing::HasSubstr("t_start"));
}

constexpr const char* kPressedThroughTheCam = R"({"beam": {"model": "rigid"}, "hub": {"drive": {"type": "prescribed",
    "law": "constant", "speed": -1}}, "initial": {"angle": 1}, "time": {"end": 2}, "outputs": [
    {"type": "impacts", "file": "bad.json"}, {"type": "trajectory", "file": "early.csv", "times": [0, 0.1]},
    {"type": "still", "file": "bad.png", "at": "impact:99"}]})";

// Its outputs are rejected, also those whose times need the motion; those of the other scene are written.
TEST(Partial, AFailedMotionCostsOnlyItsOwnOutputs) {
    const Folder folder;
    folder.write("bad_scene.json", kPressedThroughTheCam);
    folder.write("good_scene.json", R"({"time": {"end": 0.1}, "outputs": [{"type": "summary", "file": "good.json"}]})");
    const Finished run = shell(folder, "$BEAMCAM run bad_scene.json good_scene.json");
    EXPECT_EQ(run.code, 4) << run.err;
    EXPECT_THAT(run.err, ::testing::HasSubstr("of 4 outputs could not be written"));
    EXPECT_FALSE(std::filesystem::exists(folder / "bad.json"));
    EXPECT_FALSE(std::filesystem::exists(folder / "bad.png"));
    EXPECT_TRUE(std::filesystem::exists(folder / "bad.partial.json")) << run.err;
    EXPECT_TRUE(std::filesystem::exists(folder / "good.json")) << run.err;
}

}  // namespace
}  // namespace beamcam::scenes::testing
