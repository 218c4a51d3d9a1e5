// Sequences of frames, and files that belong to another one.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;
using testing::Finished, testing::Folder, testing::shell;
using ::testing::HasSubstr, ::testing::Not;

// A drive table of 20 000 points makes a scene of half a megabyte.
TEST(Frames, OnlyTheFirstOneCarriesTheScene) {
    const Folder folder;
    std::string t, theta;
    for (int i = 0; i < 20000; ++i) {
        t += fmt::format("{}{}", i ? "," : "", i * 1e-4);
        theta += fmt::format("{}{:.9f}", i ? "," : "", 0.785 - 1e-6 * i);
    }
    folder.write("s.json", R"({"hub": {"drive": {"type": "prescribed", "law": "table", "t": [)" + t +
                               R"(], "theta": [)" + theta + R"(]}}, "time": {"end": 0.2}, "outputs": [
        {"type": "frames", "file": "f-##.png", "fps": 20, "size": [64, 64], "view": {"style": "flat"}}]})");
    ASSERT_EQ(shell(folder, "$BEAMCAM run s.json -q -j 2").code, 0);
    EXPECT_GT(fs::file_size(folder / "f-00.png"), 100'000u);
    for (const char* later : {"f-01.png", "f-02.png", "f-03.png"}) EXPECT_LT(fs::file_size(folder / later), 10'000u);
    const Finished first = shell(folder, "$BEAMCAM info f-00.png --scene"),
                   later = shell(folder, "$BEAMCAM info f-02.png --scene");
    EXPECT_EQ(first.code, 0);
    EXPECT_EQ(later.out, first.out);
    EXPECT_THAT(shell(folder, "$BEAMCAM info f-02.png").out, HasSubstr("f-00.png"));
    fs::remove(folder / "f-00.png");
    EXPECT_EQ(shell(folder, "$BEAMCAM info f-02.png").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM info f-02.png --scene").code, 6);
}

TEST(UpToDate, AFileIsWrittenAgainIfOneThatBelongsToItIsMissing) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.2}, "outputs": [
        {"type": "video", "file": "a.mp4", "poster": 0.1, "fps": 10, "size": [64, 64], "view": {"style": "flat"}},
        {"type": "figure", "figure": "series", "channels": ["theta"], "file": "b.svg", "data": "b.csv"}]})");
    const Finished made = shell(folder, "$BEAMCAM run s.json");
    ASSERT_EQ(made.code, 0) << made.err;
    std::vector<std::string> beside;
    for (const auto& file : fs::directory_iterator(folder.path()))
        if (const std::string name = file.path().filename().string(); name == "a.png" || name == "b.csv")
            beside.push_back(name);
    ASSERT_FALSE(beside.empty()) << made.err;
    EXPECT_THAT(shell(folder, "$BEAMCAM run s.json").err, Not(HasSubstr("wrote")));
    for (const std::string& name : beside) {
        fs::remove(folder / name);
        const Finished again = shell(folder, "$BEAMCAM run s.json");
        EXPECT_EQ(again.code, 0) << again.err;
        EXPECT_TRUE(fs::exists(folder / name)) << name << again.err;
    }
}

}  // namespace
}  // namespace beamcam::scenes
