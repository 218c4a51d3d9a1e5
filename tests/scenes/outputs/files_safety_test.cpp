// What runs do to the files of a folder: nothing of the user's is lost, nothing half-written or unrecorded stays, and a
// mistake costs its own output alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;
using testing::Finished, testing::Folder, testing::shell, testing::slurp;
using ::testing::HasSubstr;

// A film with a poster, which is finished long before the film is.
constexpr const char* kFilm =
    "env --default-signal=INT $BEAMCAM render s.json -o out/f.mp4 --poster 0.01 --size 1280x720 --fps 240 -q -j1";

// Ends the run with the signal as soon as the poster is there.
std::string stopped_at_poster(const std::string& signal) {
    return std::string(kFilm) + " & p=$!; while kill -0 $p 2>/dev/null && [ ! -e out/f.png ]; do :; done; kill -" +
           signal + " $p; wait $p";
}

TEST(FileSafety, WhatASignalLeavesIsRecordedOrAbsent) {
    for (const std::string signal : {"INT", "TERM", "KILL"}) {
        const Folder folder;
        fs::create_directory(folder / "out");
        folder.write("s.json", R"({"time": {"end": 1.5}})");
        const Finished stopped = shell(folder, "" + stopped_at_poster(signal));
        EXPECT_EQ(stopped.code, signal == "KILL" ? 137 : 130) << stopped.err;
        ASSERT_TRUE(fs::exists(folder / "out/f.png"));
        const Finished again =
            shell(folder, "$BEAMCAM render s.json -o out/f.mp4 --poster 0.01 --to 0.05 --size 96x96 -q");
        EXPECT_EQ(again.code, 0) << signal << again.err;
        // What a kill left half-written goes when it is an hour old.
        shell(folder,
              "find out -name '.*.part' -exec touch -d '2 hours ago' {} +; $BEAMCAM render s.json -o out/g.png --at 0 "
              "--size 64x64 -q");
        std::vector<std::string> left;
        for (const auto& file : fs::directory_iterator(folder / "out")) left.push_back(file.path().filename().string());
        EXPECT_THAT(left, ::testing::UnorderedElementsAre("f.mp4", "f.png", "g.png", ".beamcam.jsonl")) << signal;
    }
}

TEST(FileSafety, AFileThatTheUserPutsWhereAKilledRunWasAboutToIsKept) {
    const Folder folder;
    fs::create_directory(folder / "out");
    folder.write("s.json", R"({"time": {"end": 1.5}})");
    EXPECT_EQ(shell(folder, stopped_at_poster("KILL")).code, 137);
    ASSERT_FALSE(fs::exists(folder / "out/f.mp4"));
    folder.write("out/f.mp4", "my own film");
    const Finished again = shell(folder, "$BEAMCAM render s.json -o out/f.mp4 --to 0.05 --size 96x96 -q");
    EXPECT_EQ(again.code, 6);
    EXPECT_THAT(again.err, HasSubstr("out/f.mp4 exists and was not made by beamcam"));
    EXPECT_EQ(slurp(folder / "out/f.mp4"), "my own film");
}

TEST(FileSafety, OutputsDoNotLeaveTheirFolderThroughLinks) {
    const Folder folder;
    for (const char* each : {"out", "elsewhere"}) fs::create_directory(folder / each);
    fs::create_directory_symlink("../elsewhere", folder / "out/link");
    fs::create_symlink("../elsewhere/t.csv", folder / "out/t.csv");
    for (const char* file : {"link/t.csv", "link/new/t.csv", "t.csv"}) {
        folder.write("s.json", std::string(R"({"time": {"end": 0.1}, "outputs": [{"type": "trajectory", "file": ")") +
                                   file + R"("}]})");
        const Finished finished = shell(folder, "$BEAMCAM run s.json -o out -q --force");
        EXPECT_EQ(finished.code, 6) << file << finished.err;
        EXPECT_THAT(finished.err, HasSubstr("a symbolic link leads it out of out"));
        EXPECT_TRUE(fs::is_empty(folder / "elsewhere")) << file;
    }
}

TEST(FileSafety, AnInstantThatIsNeverReachedCostsItsOwnOutputAlone) {
    const Folder folder;
    folder.write("s.json",
                 "{\"time\": {\"end\": 0.3}, \"outputs\": [\n"
                 "  {\"type\": \"still\", \"file\": \"a.png\", \"at\": 0.1, \"size\": [96, 96]},\n"
                 "  {\"type\": \"still\", \"file\": \"b.png\", \"at\": \"impact:9\", \"size\": [96, 96]},\n"
                 "  {\"type\": \"video\", \"file\": \"c.gif\", \"size\": [96, 96],\n"
                 "   \"speed\": {\"around\": \"impacts\", \"collisions\": [1, 9]}},\n"
                 "  {\"type\": \"trajectory\", \"file\": \"t.csv\"}]}\n");
    folder.write("other.json", R"({"time": {"end": 0.2}, "outputs": [{"type": "trajectory", "file": "other.csv"}]})");
    folder.write("broken.json", R"({"time": {"end": -1}})");
    const Finished finished = shell(folder, "$BEAMCAM run missing.json s.json broken.json other.json -o out -q");
    EXPECT_EQ(finished.code, 3);
    EXPECT_THAT(finished.err, HasSubstr("s.json:3:3: b.png: impact 9 does not occur"));
    EXPECT_THAT(finished.err,
                HasSubstr("s.json:4:3: c.gif: collision 9 does not occur: the motion has 1 of them until 0.3 s"));
    EXPECT_THAT(finished.err, HasSubstr("missing.json does not exist"));
    EXPECT_THAT(finished.err, HasSubstr("broken.json:1:18"));
    for (const char* made : {"out/a.png", "out/t.csv", "out/other.csv"}) EXPECT_TRUE(fs::exists(folder / made)) << made;
    EXPECT_EQ(shell(folder, "$BEAMCAM run missing.json other.json -o out -q").code, 6);
    EXPECT_EQ(shell(folder, "$BEAMCAM run broken.json other.json -o out -q").code, 3);
}

// A folder in the place of a file, no permission, a list of files that is none: never a bug of the program.
// The exit code is that of the first error.
TEST(FileSafety, EachOutputThatCannotBeWrittenIsReportedAndTheOthersAreWritten) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.1}, "outputs": [
  {"type": "trajectory", "file": "a.csv"},
  {"type": "impacts", "file": "i.csv"},
  {"type": "still", "at": 0.05, "file": "c.png", "size": [1920, 1080], "view": {"style": "flat"}},
  {"type": "still", "at": "impact:9", "file": "never.png", "size": [64, 64], "view": {"style": "flat"}}]})");
    const Finished finished = shell(folder, "ulimit -f 20; $BEAMCAM run s.json -o out -q");
    EXPECT_EQ(finished.code, 3);  // of never.png
    for (const char* file : {"s.json:2:3: a.csv: cannot write", "s.json:4:3: c.png: cannot write", "5:3: never.png: "})
        EXPECT_THAT(finished.err, HasSubstr(file));
    EXPECT_THAT(finished.err, HasSubstr("3 of 4 outputs could not be written"));
    EXPECT_TRUE(fs::exists(folder / "out/i.csv"));
    EXPECT_EQ(shell(folder, "ulimit -f 20; $BEAMCAM simulate s.json --trajectory t.csv --impacts j.csv -q").code, 6);
    EXPECT_TRUE(fs::exists(folder / "j.csv"));
}

TEST(FileSafety, AMissingSceneCostsNoOther) {
    const Folder folder;
    folder.write("a.json", R"({"time": {"end": 0.1}, "outputs": [{"type": "summary", "file": "a-summary.json"}]})");
    folder.write("b.json", R"({"time": {"end": 0.1}, "outputs": [{"type": "summary", "file": "b-summary.json"}]})");
    const Finished run = shell(folder, "$BEAMCAM run a.json nowhere.json b.json -q");
    EXPECT_EQ(run.code, 6);
    EXPECT_THAT(run.err, HasSubstr("nowhere.json does not exist"));
    EXPECT_TRUE(fs::exists(folder / "a-summary.json"));
    EXPECT_TRUE(fs::exists(folder / "b-summary.json"));
}

// Runs the command as a user who may have so many processes and threads. Those of all programs of a user count, so each
// test program has its own.
Finished with_threads(const Folder& folder, int most, const std::string& command) {
    return shell(folder, "chmod 777 .; as='prlimit --nproc=" + std::to_string(most) +
                             "'; if [ $(id -u) = 0 ]; then as=\"setpriv --reuid " +
                             std::to_string(20000 + getpid() % 40000) +
                             " --clear-groups $as\"; fi; "
                             "HOME=$PWD ASAN_OPTIONS=detect_leaks=0 timeout -s KILL 60 $as $BEAMCAM " +
                             command);  // the search for leaks needs a thread of its own
}

// Root may do anything, and another user may not reach the program.
bool another_user_can_run() { return with_threads(Folder(), 10000, "--version").code == 0; }
constexpr const char* kNoOtherUser = "another user cannot run the program here";

TEST(FileSafety, WithoutThreadsAFilmEndsWithAMessageAndIsMadeLater) {
    if (!another_user_can_run()) GTEST_SKIP() << kNoOtherUser;
    for (const std::string film : {"f.mp4", "f.mkv", "f.webm", "f.mov", "f.gif"}) {
        const Folder folder;
        folder.write("s.json", R"({"time": {"end": 0.2}})");
        const std::string command = "render s.json --size 96x96 --fps 10 --style flat -q -o " + film;
        if (shell(folder, "$BEAMCAM " + command).code == 5) continue;  // without this encoder
        for (const int most : {1, 4}) {
            fs::remove(folder / film.substr(0, film.find(' ')));
            const Finished run = with_threads(folder, most, command);
            if (most > 1 && run.code == 0) continue;
            // The thread that feeds an encoder, or one of the encoder's own.
            EXPECT_EQ(run.code, most > 1 ? 3 : 6) << film << run.err;
            EXPECT_THAT(run.err, HasSubstr(most > 1 ? "rejects films of" : "no thread can be started"));
            EXPECT_FALSE(fs::exists(folder / film.substr(0, film.find(' '))));
        }
        const Finished run = with_threads(folder, 10000, command);
        EXPECT_EQ(run.code, 0) << film;
        EXPECT_EQ(run.err, "") << film;  // encoders are quiet, too
    }
}

// Pango may search for fonts in threads, and GLib ends the process when it cannot start one.
TEST(FileSafety, WithoutThreadsAPictureIsMadeOrEndsWithAMessage) {
    if (!another_user_can_run()) GTEST_SKIP() << kNoOtherUser;
    for (const char* output :
         {"render s.json -o s.png --at 0 --size 96x96 --style flat -q", "figure s.json angle -o s.pdf -q"})
        for (const int most : {1, 2, 3, 4}) {
            const Folder folder;
            folder.write("s.json", R"({"time": {"end": 0.1}})");
            const Finished run = with_threads(folder, most, output);
            if (run.code == 0) continue;
            EXPECT_EQ(run.code, 6) << output << run.err;
            EXPECT_THAT(run.err, HasSubstr("no thread could be started")) << output;
        }
}

// Mesa would wait forever for threads of its own.
TEST(GlSafety, WithoutThreadsALitFilmIsMadeOrEndsWithAMessage) {
    if (!another_user_can_run()) GTEST_SKIP() << kNoOtherUser;
    for (int most = 1; most < 14; most += 2) {
        const Folder folder;
        folder.write("s.json", R"({"time": {"end": 0.1}})");
        const Finished run = with_threads(folder, most, "render s.json -o s.mkv --size 96x96 --fps 10 --style lit -q");
        if (run.code == 0) continue;
        EXPECT_EQ(run.code, 6) << most << run.err;
        EXPECT_THAT(run.err, ::testing::ContainsRegex("no thread (can|could) be started"));
    }
}

TEST(FileSafety, ErrorsOfTheFileSystemAreToldWithPathAndCause) {
    if (!another_user_can_run()) GTEST_SKIP() << kNoOtherUser;
    const std::pair<const char*, const char*> cases[] = {
        {"mkdir -p out/t.csv", "out/t.csv: Is a directory"},
        {"mkdir -p out/.beamcam.jsonl", "out/.beamcam.jsonl"},
        {"'\"$BEAMCAM\"' run s.json -o out -q; touch -d 2001-01-01 out/t.csv; chmod 0 out/t.csv",
         "out/t.csv: Permission denied"},
        {"mkdir out; touch out/.beamcam.jsonl; chmod 0 out/.beamcam.jsonl; touch out/t.csv",
         "out/.beamcam.jsonl: Permission denied"},
        {"mkdir out; chmod a-x out", "Permission denied"},
        {"mkdir out; chmod a-w out", "out/t.csv: Permission denied"},
        {"touch out", "out"},
        {"ln -s out out", "out"}};
    for (const auto& [setting, message] : cases) {
        const Folder folder;
        folder.write("s.json", R"({"time": {"end": 0.1}, "outputs": [{"type": "trajectory", "file": "t.csv"}]})");
        // Root may read and write anything.
        const Finished finished =
            shell(folder,
                  "chmod 777 .; run() { if [ $(id -u) = 0 ]; then setpriv --reuid 65534 --clear-groups \"$@\"; "
                  "else \"$@\"; fi; }; run sh -c '" +
                      std::string("umask 0; ") + setting +
                      "' 2>/dev/null; run $BEAMCAM run s.json -o out -q; c=$?; chmod -R u+rwx out; exit $c");
        EXPECT_EQ(finished.code, 6) << setting << finished.err;
        EXPECT_THAT(finished.err, HasSubstr(message)) << setting;
    }
}

TEST(FileSafety, AFolderThatCannotBeWrittenIsReportedBeforeAnyWork) {
    if (!another_user_can_run()) GTEST_SKIP() << kNoOtherUser;
    for (const char* command : {"simulate s.json --trajectory out/m.csv", "figure s.json angle -o out/a.pdf",
                                "render s.json -o out/a.png --at 0", "cam s.json -o out/c.csv"}) {
        const Folder folder;
        folder.write("s.json", R"({"time": {"end": 1e6}})");
        fs::create_directory(folder / "out");
        const Finished finished = with_threads(folder, 10000, command);
        EXPECT_EQ(finished.code, 6) << command << finished.err;
        EXPECT_THAT(finished.err, HasSubstr("Permission denied")) << command;
    }
}

TEST(FileSafety, InAStickyFolderTheListOfAnotherUserIsLeftAlone) {
    if (!another_user_can_run() || getuid() != 0) GTEST_SKIP() << kNoOtherUser;
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.1}})");
    const std::string own = "mkdir out; touch out/.beamcam.jsonl; chown 12345 out/.beamcam.jsonl; chmod 1777 out";
    ASSERT_EQ(shell(folder, own).code, 0);
    const Finished finished = with_threads(folder, 10000, "simulate s.json --trajectory out/m.csv -q");
    EXPECT_EQ(finished.code, 0) << finished.err;
    EXPECT_EQ(slurp(folder / "out/.beamcam.jsonl"), "");
}

TEST(FileSafety, AFileThatMayNotBeReadIsNotToldToBeEmpty) {
    if (!another_user_can_run()) GTEST_SKIP() << kNoOtherUser;
    const Folder folder;
    for (const char* command : {"hash x.png", "hash x.mp4", "info x.png", "info x.csv", "diff x.csv x.csv",
                                "diff x.png x.png", "run x.json", "test x.json", "check x.json"})
        for (const char* content : {"", "x"}) {
            const Finished finished =
                shell(folder, std::string("chmod 777 .; f=$(echo '") + command +
                                  "' | grep -o 'x[.][a-z0-9]*' | head -1); rm -f $f; printf '" + content +
                                  "' > $f; chmod 0 $f; if [ $(id -u) = 0 ]; then setpriv --reuid 65534 "
                                  "--clear-groups $BEAMCAM " +
                                  command + "; else $BEAMCAM " + command + "; fi");
            EXPECT_EQ(finished.code, 6) << command << finished.err;
            EXPECT_THAT(finished.err, HasSubstr("Permission denied")) << command;
        }
}

}  // namespace
}  // namespace beamcam::scenes
