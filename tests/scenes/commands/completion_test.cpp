// What the program writes about itself: completion for shells, the manual; and the scenes that come with it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "scenes/commands/commands.hpp"
#include "scenes/format/embedded.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished, testing::Folder, testing::shell;
using ::testing::HasSubstr, ::testing::Not;

// What bash offers after these words.
std::string completed(const Folder& folder, const std::string& words) {
    return shell(folder, "export BEAMCAM; bash -c 'eval \"$(\"$BEAMCAM\" completion bash)\"; COMP_WORDS=(beamcam " +
                             words +
                             "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); "
                             "_beamcam \"$BEAMCAM\" \"${COMP_WORDS[-1]}\"; printf \"%s\\n\" \"${COMPREPLY[@]}\"'")
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
}

TEST(Completion, EveryShellKnowsEveryCommandAndOption) {
    const Folder folder;
    Program program;
    for (const auto add : kCommands) add(program);
    for (const std::string name : {"bash", "zsh", "fish"}) {
        const std::string script = shell(folder, "$BEAMCAM completion " + name).out;
        for (const CLI::App* command : commands_of(program)) {
            EXPECT_THAT(script, HasSubstr(" " + command->get_name())) << name;
            for (const CLI::Option* option : options_of(*command))
                for (const std::string& dashed : option->get_lnames())
                    EXPECT_THAT(script, HasSubstr(" --" + dashed)) << name;
        }
        folder.write("script", script);
        if (shell(folder, "command -v " + name).code == 0) {
            EXPECT_EQ(shell(folder, name + " -n script").code, 0) << name;
        }
    }
    EXPECT_EQ(shell(folder, "$BEAMCAM completion tcsh").code, 2);
}

TEST(Manual, NamesEveryCommandOptionAndExitCode) {
    const Folder folder;
    const Finished manual = shell(folder, "$BEAMCAM manual");
    ASSERT_EQ(manual.code, 0);
    Program program;
    for (const auto add : kCommands) add(program);
    for (const CLI::App* command : commands_of(program))
        EXPECT_THAT(manual.out, HasSubstr(".SS beamcam " + command->get_name() + "\n"));
    for (const char* words : {"\\-\\-background", "interrupted", "BEAMCAM_GL"})
        EXPECT_THAT(manual.out, HasSubstr(words));
    if (shell(folder, "command -v groff").code == 0) {
        const Finished checked = shell(folder, "$BEAMCAM manual | groff -k -man -ww -Tutf8 -z");
        EXPECT_EQ(checked.err, "");
    }
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
    }
    EXPECT_EQ(shell(folder, "$BEAMCAM init --from fast-cam -q && grep -c fast-cam.mp4 fast-cam.json").out, "1\n");
    EXPECT_EQ(shell(folder, "$BEAMCAM init quick --from fast-cam -q && grep -c quick.mp4 quick.json").out, "1\n");
    const Finished unknown = shell(folder, "$BEAMCAM init --from fast-can");
    EXPECT_EQ(unknown.code, 2);
    EXPECT_THAT(unknown.err, HasSubstr("fast-cam"));
}

}  // namespace
}  // namespace beamcam::scenes
