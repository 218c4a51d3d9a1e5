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

}  // namespace
}  // namespace beamcam::scenes::testing
