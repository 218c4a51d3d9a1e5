// What comes with the program: completion for bash, and scenes to start from.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "scenes/format/embedded.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished, testing::Folder, testing::shell;
using ::testing::HasSubstr;

// What bash offers after these words.
std::string completed(const Folder& folder, const std::string& words) {
    return shell(folder,
                 "bash -c '. \"" BEAMCAM_TEST_DIR "/../scenes/completion.bash\"; COMP_WORDS=(beamcam " + words +
                     "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); "
                     "_beamcam \"$0\" \"${COMP_WORDS[-1]}\"; printf \"%s\\n\" \"${COMPREPLY[@]}\"' \"$BEAMCAM\"")
        .out;
}

TEST(Completion, BashOffersCommandsOptionsAndFiles) {
    const Folder folder;
    folder.write("a scene.json", "{}");
    EXPECT_EQ(completed(folder, "sim"), "simulate\n");
    EXPECT_EQ(completed(folder, "render --backg"), "--background\n");
    EXPECT_EQ(completed(folder, "check a"), "a scene.json\n");
    EXPECT_EQ(completed(folder, "run --set cam.speed=1 a"), "a scene.json\n");
    EXPECT_EQ(completed(folder, "no-command --f"), "\n");
    EXPECT_EQ(completed(folder, "simulate --state-"), "--state-at\n");
    EXPECT_EQ(completed(folder, "run --o"), "--output\n");
}

TEST(Examples, EachIsListedWithALineAndCopied) {
    const Folder folder;
    const Finished list = shell(folder, "$BEAMCAM examples");
    ASSERT_EQ(list.code, 0);
    ASSERT_GE(embedded_scenes().size(), 17U);
    for (const EmbeddedText& scene : embedded_scenes()) {
        const std::string name(scene.name);
        EXPECT_FALSE(scene.summary().empty()) << name;
        EXPECT_THAT(list.out, HasSubstr(name + " "));
        EXPECT_THAT(list.out, HasSubstr(std::string(scene.summary())));
        ASSERT_EQ(shell(folder, "$BEAMCAM init mine --force -q --from " + name).code, 0);
        const Finished check = shell(folder, "$BEAMCAM check mine.json");
        EXPECT_EQ(check.code, 0) << name << check.err;
        // The files of two scenes of one example have different names.
        EXPECT_EQ(shell(folder, "$BEAMCAM plan mine.json | grep -c ' " + name + "[.-]'").out, "0\n") << name;
    }
    EXPECT_EQ(shell(folder, "$BEAMCAM init -q fast-cam && grep -q 'fast cam' fast-cam.json").code, 0);
    const Finished unknown = shell(folder, "$BEAMCAM init --from fast-can");
    EXPECT_EQ(unknown.code, 2);
    EXPECT_THAT(unknown.err, HasSubstr("fast-cam"));
}

}  // namespace
}  // namespace beamcam::scenes
