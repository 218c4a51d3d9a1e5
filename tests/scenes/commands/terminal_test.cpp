// Control characters of foreign files never reach the terminal, whatever command prints them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "output/files/text_safety.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished, testing::Folder, testing::shell;
using ::testing::HasSubstr;

void expect_safe(const Finished& done, int code) {
    EXPECT_EQ(done.code, code) << done.err;
    EXPECT_EQ(done.out, output::visible(done.out));
    EXPECT_EQ(done.err, output::visible(done.err));
}

TEST(Terminal, TitlesOfPicturesCannotSpeakToIt) {
    const Folder folder;
    folder.write("s.json", R"({"title": "a\u001b[31mb\u009b2J\u202ec\nmade by", "outputs": [
        {"type": "still", "at": 0, "file": "p.png", "size": [64, 48], "view": {"style": "flat"}}]})");
    expect_safe(shell(folder, "$BEAMCAM run s.json"), 0);
    const Finished text = shell(folder, "$BEAMCAM info p.png");
    expect_safe(text, 0);
    EXPECT_THAT(text.out, HasSubstr("a\uFFFD[31mb\uFFFD2J\uFFFDc made by\n"));
    const Finished json = shell(folder, "$BEAMCAM info p.png --json");
    expect_safe(json, 0);
    EXPECT_THAT(json.out, HasSubstr(R"("title": "a\u001b[31mb\u009b2J\u202ec\nmade by")"));
    const Finished scene = shell(folder, "$BEAMCAM info p.png --scene");
    expect_safe(scene, 0);
    EXPECT_THAT(scene.out, HasSubstr(R"(\u009b2J\u202e)"));
    expect_safe(shell(folder, "$BEAMCAM plan s.json"), 0);
    expect_safe(shell(folder, "$BEAMCAM plan s.json --json"), 0);
}

TEST(Terminal, NamesInTablesAndOfFilesCannotSpeakToIt) {
    const Folder folder;
    folder.write("a.csv", "t,\x1b[31mred\xc2\x9b,\xff\n0,1,2\n");
    folder.write("b.csv", "t,plain\n0,1\n");
    expect_safe(shell(folder, "$BEAMCAM diff a.csv b.csv"), 7);
    expect_safe(shell(folder, "$BEAMCAM diff a.csv b.csv --json"), 7);
    const std::string name = "x\x1b]0;y\x07\xe2\x80\xae.json";
    folder.write(name, "{\"title\": 1}");
    expect_safe(shell(folder, "$BEAMCAM check '" + name + "'"), 3);
    expect_safe(shell(folder, "$BEAMCAM info '" + name + "'"), 0);
    expect_safe(shell(folder, "$BEAMCAM info '" + name + "' --json"), 0);
    expect_safe(shell(folder, "$BEAMCAM '" + name + "x'"), 2);
    expect_safe(shell(folder, "$BEAMCAM check --set 'title\x1b=\x1b[31m' '" + name + "'"), 3);
}

}  // namespace
}  // namespace beamcam::scenes
