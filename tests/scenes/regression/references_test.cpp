// The folders of references: what an update replaces, what it never touches, and what a kill leaves.
#include "scenes/regression/references.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <functional>

#include "output/files/atomic_file.hpp"
#include "tests/output/scratch.hpp"
#include "tests/scenes/support.hpp"

// The calls that change a folder, instead of the C library's: the process ends before the one that is counted to.
namespace {
int changes_left = 0;  // 0: it does not end
void count_change() {
    if (changes_left > 0 && --changes_left == 0) _exit(137);
}
int result_of(long value) { return static_cast<int>(value); }  // -1 with errno, as of the C library
}  // namespace
extern "C" {
int renameat(int a, const char* from, int b, const char* to) noexcept {
    count_change();
    return result_of(syscall(SYS_renameat2, a, from, b, to, 0));
}
int rename(const char* from, const char* to) noexcept { return renameat(AT_FDCWD, from, AT_FDCWD, to); }
int unlinkat(int folder, const char* name, int flags) noexcept {
    count_change();
    return result_of(syscall(SYS_unlinkat, folder, name, flags));
}
int unlink(const char* name) noexcept { return unlinkat(AT_FDCWD, name, 0); }
int remove(const char* name) noexcept {
    const int done = unlinkat(AT_FDCWD, name, 0);
    return done != 0 && errno == EISDIR ? unlinkat(AT_FDCWD, name, AT_REMOVEDIR) : done;
}
int rmdir(const char* name) noexcept { return unlinkat(AT_FDCWD, name, AT_REMOVEDIR); }
int mkdir(const char* name, mode_t mode) noexcept {
    count_change();
    return result_of(syscall(SYS_mkdirat, AT_FDCWD, name, mode));
}
}

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;
using output::Scratch;
using output::write_file;
using testing::slurp;

using Contents = std::map<std::string, std::string>;

// Every file below a folder.
Contents contents(const fs::path& folder) {
    Contents all;
    for (const auto& file : fs::recursive_directory_iterator(folder))
        if (file.is_regular_file()) all[file.path().lexically_relative(folder).string()] = slurp(file.path());
    return all;
}

// Updates two entries; the second one loses a file in the "new" state.
void update(const Scratch& scratch, const std::string& what, bool force = false) {
    ReferenceUpdate update(scratch / "b.json", scratch / "refs", force);
    for (const std::string entry : {"a", "c"}) {
        const fs::path folder = update.replace(entry);
        write_file(folder / "0000.png", what + entry);
        if (entry == "a" || what == "old") write_file(folder / "0001.png", what);
    }
    update.commit(slurp(scratch / "b.json"), "baselines " + what, {{"a", {{"0000.png", "12ab"}}}, {"c", {}}});
}

std::string message_of(const std::function<void()>& act) {
    try {
        act();
    } catch (const output::IoError& error) {
        return error.what();
    }
    return "no error";
}

TEST(References, AnUpdateReplacesWhatTheMarkerListsAndKeepsEverythingElse) {
    Scratch scratch;
    write_file(scratch / "b.json", "first");
    update(scratch, "old");
    write_file(scratch / "refs/a/notes.txt", "mine");
    output::ensure_directory(scratch / "refs/a.old");
    write_file(scratch / "refs/a.old/x", "mine too");
    update(scratch, "new");
    const Contents all = contents(scratch.path());
    EXPECT_EQ(all.at("b.json"), "baselines new");
    EXPECT_EQ(all.at("refs/a/0000.png"), "newa");
    EXPECT_EQ(all.at("refs/a/notes.txt"), "mine");
    EXPECT_EQ(all.at("refs/a.old/x"), "mine too");
    EXPECT_FALSE(all.contains("refs/c/0001.png"));
    EXPECT_EQ(all.size(), 8u);  // and two markers
    EXPECT_EQ(marked_files(scratch / "refs/a").at("0000.png").pixels, "12ab");
    EXPECT_FALSE(marked_files(scratch / "refs/a").contains("notes.txt"));
}

TEST(References, AFolderThatIsNotMarkedIsRejectedAndUnchanged) {
    Scratch scratch;
    write_file(scratch / "b.json", "first");
    output::ensure_directory(scratch / "refs/a");
    write_file(scratch / "refs/a/fall.json", "two weeks of work");
    const Contents before = contents(scratch.path());
    EXPECT_THAT(message_of([&] { update(scratch, "new"); }),
                ::testing::HasSubstr("refs/a is not a folder of references"));
    EXPECT_EQ(contents(scratch.path()), before);
    update(scratch, "new", true);  // adopts the folder, and keeps what it does not need
    EXPECT_EQ(slurp(scratch / "refs/a/fall.json"), "two weeks of work");
    EXPECT_EQ(slurp(scratch / "refs/a/0000.png"), "newa");
}

TEST(References, AChangedFileAFileInTheWayAndALinkAreRejected) {
    const std::pair<const char*, std::function<void(const fs::path&)>> cases[] = {
        {"was changed", [](const fs::path& refs) { write_file(refs / "a/0000.png", "edited"); }},
        {"was not made by beamcam",
         [](const fs::path& refs) { write_file(refs / "a/.beamcam-reference", "beamcam reference 1\n"); }},
        {"is a symbolic link",
         [](const fs::path& refs) {
             fs::rename(refs / "a", refs / "moved");
             fs::create_directory_symlink("moved", refs / "a");
         }},
        {"is not a directory",
         [](const fs::path& refs) {
             fs::remove_all(refs / "a");
             write_file(refs / "a", "a file");
         }},
        {"damaged", [](const fs::path& refs) { write_file(refs / "a/.beamcam-reference", "?"); }},
    };
    for (const auto& [why, change] : cases) {
        Scratch scratch;
        write_file(scratch / "b.json", "first");
        update(scratch, "old");
        change(scratch / "refs");
        const Contents before = contents(scratch.path());
        EXPECT_THAT(message_of([&] { update(scratch, "new"); }), ::testing::HasSubstr(why));
        EXPECT_EQ(contents(scratch.path()), before) << why;
    }
}

TEST(References, BaselinesThatWereEditedMeanwhileAreKept) {
    Scratch scratch;
    write_file(scratch / "b.json", "first");
    ReferenceUpdate update(scratch / "b.json", scratch / "refs", false);
    write_file(update.replace("a") / "0000.png", "x");
    write_file(scratch / "b.json", "edited");
    EXPECT_THROW(update.commit("first", "second", {{"a", {}}}), output::WouldOverwrite);
    EXPECT_EQ(slurp(scratch / "b.json"), "edited");
}

TEST(References, OneUpdateAtATime) {
    Scratch scratch;
    write_file(scratch / "b.json", "first");
    ReferenceUpdate update(scratch / "b.json", scratch / "refs", false);
    update.extend("a");
    EXPECT_THAT(message_of([&] { ReferenceUpdate(scratch / "b.json", scratch / "refs", false).extend("a"); }),
                ::testing::HasSubstr("in progress"));
    EXPECT_EQ(ReferenceUpdate::recover(scratch / "refs"), "");
    EXPECT_TRUE(fs::exists(scratch / "refs/.beamcam-update"));
}

TEST(References, AFolderInThePlaceOfTheCollectionIsNeverRemoved) {
    Scratch scratch;
    output::ensure_directory(scratch / "refs/.beamcam-update");
    write_file(scratch / "refs/.beamcam-update/notes.txt", "mine");
    EXPECT_THROW(ReferenceUpdate::recover(scratch / "refs"), output::WouldOverwrite);
    EXPECT_EQ(slurp(scratch / "refs/.beamcam-update/notes.txt"), "mine");
}

// The picture of another renderer is put beside the others.
void extend(const Scratch& scratch) {
    ReferenceUpdate update(scratch / "b.json", scratch / "refs", false);
    write_file(update.extend("a") / "0000-0123456789ab.png", "a");
    update.commit(slurp(scratch / "b.json"), "baselines extended", {{"a", {{"0000-0123456789ab.png", "34cd"}}}});
}

TEST(References, WhatIsAddedLeavesAllElseAsItIs) {
    Scratch scratch;
    write_file(scratch / "b.json", "first");
    update(scratch, "old");
    Contents expected = contents(scratch.path());
    extend(scratch);
    expected["b.json"] = "baselines extended";
    expected["refs/a/0000-0123456789ab.png"] = "a";
    Contents all = contents(scratch.path());
    EXPECT_THAT(all.at("refs/a/.beamcam-reference"),
                ::testing::HasSubstr(expected.at("refs/a/.beamcam-reference").substr(20)));
    EXPECT_EQ(marked_files(scratch / "refs/a").at("0000-0123456789ab.png").pixels, "34cd");
    expected["refs/a/.beamcam-reference"] = all.at("refs/a/.beamcam-reference");
    EXPECT_EQ(all, expected);
    update(scratch, "new");  // and goes with them
    EXPECT_FALSE(contents(scratch.path()).contains("refs/a/0000-0123456789ab.png"));
}

// The process ends at each of its changes of the file system in turn, as a kill ends it: afterwards everything is old
// or everything is new, and nothing else is left.
void torture(const std::function<void(const Scratch&)>& act) {
    Scratch before_all, after_all;
    for (const Scratch* scratch : {&before_all, &after_all}) {
        write_file(*scratch / "b.json", "first");
        update(*scratch, "old");
    }
    act(after_all);
    const Contents before = contents(before_all.path()), after = contents(after_all.path());
    int undone = 0, completed = 0;
    constexpr int kFarBeyondTheLast = 1000;
    for (int step = 1; step < kFarBeyondTheLast; ++step) {
        Scratch scratch;
        write_file(scratch / "b.json", "first");
        update(scratch, "old");
        const int code = output::exit_code_of([&] {
            changes_left = step;
            act(scratch);
            return 0;
        });
        ReferenceUpdate::recover(scratch / "refs");
        const Contents now = contents(scratch.path());
        ASSERT_TRUE(now == before || now == after) << "killed at change " << step;
        (now == before ? undone : completed) += 1;
        if (code == 0) break;
        ASSERT_EQ(code, 137);
    }
    EXPECT_GT(undone, 5);
    EXPECT_GT(completed, 5);
}

TEST(References, AnUpdateThatIsKilledAnywhereIsCompletedOrUndone) {
    torture([](const Scratch& scratch) { update(scratch, "new"); });
}
TEST(References, AnAdditionThatIsKilledAnywhereIsCompletedOrUndone) { torture(extend); }

}  // namespace
}  // namespace beamcam::scenes
