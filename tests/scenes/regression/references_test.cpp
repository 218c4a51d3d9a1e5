// References as plain files: what an update writes, what it never touches, and what git does with them.
#include "scenes/regression/references.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "scenes/motions/identity.hpp"
#include "tests/scenes/regression/guarded.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf, ::testing::ElementsAre, ::testing::HasSubstr, ::testing::IsEmpty, ::testing::Not;
using testing::Finished, testing::Folder, testing::Guarded, testing::kBaselines, testing::shell, testing::slurp;

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& file : fs::directory_iterator(folder)) names.push_back(file.path().filename().string());
    std::ranges::sort(names);
    return names;
}

// Every file below a folder.
std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> all;
    for (const auto& file : fs::recursive_directory_iterator(folder))
        if (file.is_regular_file() && !file.path().filename().string().starts_with(".std"))
            all[file.path().lexically_relative(folder).string()] = slurp(file.path());
    return all;
}

TEST(References, AreFilesThatPeopleKnowAndTheBaselinesStayAsTheyAre) {
    const Guarded folder;
    const Finished updated = folder.update();
    EXPECT_EQ(updated.code, 7) << updated.err;
    EXPECT_THAT(updated.out, HasSubstr("wrote       b/fall/0000.png"));
    EXPECT_EQ(slurp(folder / "b.json"), kBaselines);
    EXPECT_THAT(names_in(folder / "b/fall"), ElementsAre("0000.png", "digests.json", "impacts.json", "motion.csv"));
    EXPECT_THAT(names_in(folder / "b/motion"), ElementsAre("digests.json", "impacts.json", "motion.csv"));
    EXPECT_EQ(slurp(folder / "b/motion/digests.json"), "{}\n");
    EXPECT_THAT(slurp(folder / "b/fall/digests.json"), HasSubstr("\"" + flat_fingerprint() + "\": ["));
    EXPECT_THAT(slurp(folder / "b/fall/impacts.json"), HasSubstr("\"reproducible_until\": 0.35"));
}

TEST(References, FramesThatAreNotDrawnAnyMoreGoAndFilesOfTheUserStay) {
    const Guarded folder;
    folder.update();
    for (const char* own : {"b/hit/notes.txt", "b/hit/1.png", "b/hit/motion-old.csv"}) folder.write(own, "mine");
    folder.swap("b.json", R"("to": 0.35)", R"("to": 0.30)");
    EXPECT_THAT(shell(folder, "$BEAMCAM test b.json --filter hit").out, HasSubstr("1 picture drawn, 2 expected"));
    const Finished updated = shell(folder, "$BEAMCAM test b.json --update hit");
    EXPECT_THAT(updated.out, HasSubstr("removed     b/hit/0001.png"));
    EXPECT_THAT(names_in(folder / "b/hit"), ElementsAre("0000.png", "1.png", "digests.json", "impacts.json",
                                                        "motion-old.csv", "motion.csv", "notes.txt"));
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --filter hit --strict").code, 0);
}

// ---- git ---------------------------------------------------------------------------------------------

// The baselines in a repository, with one commit.
struct Repository : Guarded {
    Repository() {
        update();
        git("init -q . && git add b b.json s.json");
        git("commit -qm first");
    }
    Finished git(const std::string& arguments) const {
        return shell(*this, "git -c user.name=n -c user.email=a@b.c " + arguments);
    }
    Finished test(const std::string& options = "--strict") const {
        return shell(*this, "$BEAMCAM test b.json " + options);
    }
};

TEST(ReferencesInGit, ShowsCommitsAndUndoesAnUpdate) {
    const Repository folder;
    folder.write("s.json", R"({"time": {"end": 0.35}, "title": "another"})");
    EXPECT_EQ(folder.test("--update fall").code, 7);
    EXPECT_EQ(folder.git("status --short -uno").out, " M b/fall/0000.png\n M b/fall/digests.json\n M s.json\n");
    EXPECT_EQ(folder.test("--filter fall --strict").code, 0);
    folder.git("checkout -q -- b");
    EXPECT_EQ(folder.test("--filter fall").code, 7);
    folder.git("checkout -q -- .");
    EXPECT_EQ(folder.test().code, 0);
}

TEST(ReferencesInGit, EntriesAreDeletedRenamedAndTakenFromOlderCommits) {
    const Repository folder;
    folder.git("rm -qr b/hit");
    EXPECT_THAT(folder.test().out, AllOf(HasSubstr("missing     hit"), HasSubstr("identical   fall")));
    folder.git("reset -q --hard");
    folder.git("mv b/fall b/drop");
    folder.swap("b.json", "\"fall\":", "\"drop\":");
    EXPECT_EQ(folder.test().code, 0);
    folder.git("reset -q --hard");
    folder.write("s.json", R"({"time": {"end": 0.35}, "gravity": 9.7})");
    EXPECT_EQ(folder.test("--update").code, 7);  // all of them
    folder.git("commit -qam second");
    EXPECT_EQ(folder.test().code, 0);
    folder.git("checkout -q HEAD~1 -- b/fall b/motion");
    const Finished older = folder.test();
    EXPECT_EQ(older.code, 7);
    EXPECT_THAT(older.out, AllOf(HasSubstr("different   fall"), HasSubstr("different   motion"),
                                 HasSubstr("identical   hit"), HasSubstr("identical   fast")));
    folder.git("checkout -q HEAD~1 -- s.json b");
    EXPECT_EQ(folder.test().code, 0);
    folder.git("rm -q --cached b/fall/digests.json");
    fs::remove(folder / "b/fall/digests.json");
    EXPECT_EQ(folder.test().code, 0);  // the pictures decide
}

TEST(ReferencesInGit, LineEndsThatACheckoutConvertsMakeNoDifference) {
    const Repository folder;
    for (const std::string copy : {"converted", "with-attributes"}) {
        if (copy == "with-attributes") {
            folder.write(".gitattributes", "* text=auto eol=crlf\n");
            folder.git("add .gitattributes");
            folder.git("commit -qm crlf");
        }
        const std::string how = copy == "converted" ? "-c core.autocrlf=true " : "";
        ASSERT_EQ(folder.git("clone -q " + how + ". " + copy).code, 0);
        ASSERT_THAT(slurp(folder / (copy + "/b/motion/motion.csv")), HasSubstr("\r\n"));
        ASSERT_THAT(slurp(folder / (copy + "/b/motion/impacts.json")), HasSubstr("\r\n"));
        const Finished tested = shell(folder, "cd " + copy + "; $BEAMCAM test b.json --strict");
        EXPECT_EQ(tested.code, 0) << tested.out << tested.err;
        EXPECT_EQ(shell(folder, "cd " + copy + "; $BEAMCAM test b.json --update").code, 0);
        EXPECT_EQ(shell(folder, "cd " + copy + "; git status --short -uno").out, "");
    }
}

TEST(ReferencesInGit, AnUpdateInAFreshCloneNeedsNoForce) {
    const Repository folder;
    folder.git("clone -q . copy");
    folder.write("copy/s.json", R"({"time": {"end": 0.35}, "title": "another"})");
    const Finished updated =
        shell(folder, "export XDG_STATE_HOME=$PWD/state; cd copy; $BEAMCAM test b.json --update fall");
    EXPECT_EQ(updated.code, 7) << updated.err;
    EXPECT_EQ(shell(folder, "cd copy; git diff --stat | tail -n 1").out.substr(0, 16), " 3 files changed");
}

// ---- several sorts of machines -------------------------------------------------------------------------

// The references were accepted on a machine whose pictures are these ones, two levels darker.
struct OtherMachine : Guarded {
    OtherMachine() {
        shell(*this, "$BEAMCAM test b.json --update fast");
        shell(*this,
              "ffmpeg -v error -i b/fast/0000.png -vf 'lutrgb=r=max(val-2\\,0)' -y x.png && mv x.png b/fast/0000.png");
        swap("b/fast/digests.json", flat_fingerprint(), "0123456789ab");
    }
    Finished test(const std::string& options) const {
        return shell(*this, "$BEAMCAM test b.json --filter fast " + options);
    }
};

TEST(References, TwoSortsOfMachinesShareThemByTolerance) {
    const OtherMachine folder;
    const Finished exact = folder.test("");
    EXPECT_EQ(exact.code, 7);
    EXPECT_THAT(exact.out, HasSubstr("no digest is recorded, " + flat_fingerprint()));
    folder.allow("\"channel\": 1");
    EXPECT_EQ(folder.test("").code, 7);
    folder.allow("\"channel\": 2");
    const Finished within = folder.test("");
    EXPECT_EQ(within.code, 0) << within.out;
    EXPECT_THAT(within.out, HasSubstr("equivalent  fast"));
    EXPECT_EQ(folder.test("--strict").code, 7);
}

// This machine's digests are recorded beside those of the other, whose pictures stay; a change replaces them all.
TEST(References, TheDigestsOfASecondMachineOnlySayIdentical) {
    const OtherMachine folder;
    const std::string picture = slurp(folder / "b/fast/0000.png"), motion = slurp(folder / "b/fast/motion.csv");
    folder.allow("\"channel\": 2");
    const Finished added = shell(folder, "$BEAMCAM test b.json --update fast");
    EXPECT_EQ(added.code, 7);
    EXPECT_THAT(added.out, AllOf(HasSubstr("wrote       b/fast/digests.json"), Not(HasSubstr("0000.png\n    wrote"))));
    EXPECT_EQ(slurp(folder / "b/fast/0000.png"), picture);
    EXPECT_EQ(slurp(folder / "b/fast/motion.csv"), motion);
    EXPECT_THAT(slurp(folder / "b/fast/digests.json"), HasSubstr("0123456789ab"));
    EXPECT_EQ(folder.test("--strict").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --update fast").code, 0);
    folder.allow("");
    EXPECT_EQ(folder.test("").code, 7);  // a digest never lets a picture pass
    folder.allow("\"channel\": 2");
    shell(folder, "sed -i 's/cam.speed=5/cam.speed=6/' b.json");
    EXPECT_EQ(folder.test("").code, 7);
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --update fast").code, 7);
    EXPECT_THAT(slurp(folder / "b/fast/digests.json"), Not(HasSubstr("0123456789ab")));
    EXPECT_EQ(folder.test("--strict").code, 0);
}

// ---- what an update must not touch ---------------------------------------------------------------------

TEST(References, AFolderThatIsTheUsersKeepsItsFiles) {
    for (const std::string references : {"scenes", ".", "..", "ABSOLUTE"}) {
        const Folder folder;
        fs::create_directories(folder / "x");
        const std::string at = references == ".." ? "x/b.json" : "b.json";
        const fs::path own =
            references == "scenes" || references == "ABSOLUTE" ? folder / "scenes/fall" : folder / "fall";
        fs::create_directories(own);
        const std::string named = references == "ABSOLUTE" ? (folder / "scenes").string() : references;
        folder.write(at, R"({"references": ")" + named + R"(", "entries": {"fall": {"scene": {"time": {"end": 0.1}},
            "output": {"type": "still", "at": 0.1, "size": [96, 96], "view": {"style": "flat"}}}}})");
        for (const char* name : {"fall.json", "0000.png", "0007.png", "motion.csv"})
            std::ofstream(own / name) << "two weeks of work";
        const auto before = contents(folder.path());
        const Finished refused = shell(folder, "$BEAMCAM test " + at + " --update fall");
        EXPECT_EQ(refused.code, 6) << references << refused.err;
        EXPECT_THAT(refused.out,
                    AllOf(HasSubstr("0000.png exists, and its folder has no digests.json"), HasSubstr("--force")));
        EXPECT_EQ(contents(folder.path()), before) << references;
        EXPECT_EQ(shell(folder, "$BEAMCAM test " + at + " --update fall --force").code, 7);
        EXPECT_EQ(slurp(own / "fall.json"), "two weeks of work");
        EXPECT_EQ(slurp(own / "0007.png"), "two weeks of work");
        EXPECT_NE(slurp(own / "0000.png"), "two weeks of work");
    }
}

TEST(References, LinksAreNotFollowedOutOfTheFolderOfTheBaselines) {
    const std::pair<const char*, const char*> cases[] = {
        {"the folder", "mv p/b victim/b; ln -s ../victim/b p/b"},
        {"the folder of an entry", "mv p/b/fall victim/fall; ln -s ../../victim/fall p/b/fall"},
        {"a picture", "cp p/b/fall/0000.png victim/; ln -sf ../../../victim/0000.png p/b/fall/0000.png"},
        {"a dangling link", "ln -sf ../../../victim/new p/b/fall/0000.png"},
        {"the digests", "mv p/b/fall/digests.json victim/; ln -s ../../../victim/digests.json p/b/fall/digests.json"}};
    for (const auto& [what, command] : cases) {
        const Folder folder;
        fs::create_directories(folder / "p");
        fs::create_directories(folder / "victim");
        folder.write("p/b.json", kBaselines);
        folder.write("p/s.json", R"({"time": {"end": 0.35}})");
        ASSERT_EQ(shell(folder, "$BEAMCAM test p/b.json --update fall").code, 7);
        ASSERT_EQ(shell(folder, command).code, 0) << what;
        folder.write("p/s.json", R"({"time": {"end": 0.35}, "title": "another"})");
        const auto before = contents(folder / "victim");
        shell(folder, "$BEAMCAM test p/b.json");
        const Finished updated = shell(folder, "$BEAMCAM test p/b.json --update fall");
        EXPECT_EQ(updated.code, 6) << what << updated.out << updated.err;
        EXPECT_EQ(contents(folder / "victim"), before) << what;
    }
}

TEST(References, DamagedDigestsAreAnErrorAndAnUpdateReplacesThem) {
    const Guarded folder;
    folder.update();
    const std::string right = slurp(folder / "b/fall/digests.json");
    for (const char* text : {"", "[", "3", "<<<<<<< HEAD\n{}\n=======\n"}) {
        folder.write("b/fall/digests.json", text);
        const Finished damaged = shell(folder, "$BEAMCAM test b.json --filter fall motion");
        EXPECT_EQ(damaged.code, 6) << text;
        EXPECT_THAT(damaged.out, AllOf(HasSubstr("not-run     fall"), HasSubstr("identical   motion")));
        EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --update fall").code, 7);
        EXPECT_EQ(slurp(folder / "b/fall/digests.json"), right);
    }
}

}  // namespace
}  // namespace beamcam::scenes
