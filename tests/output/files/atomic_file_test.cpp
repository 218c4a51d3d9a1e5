#include "output/files/atomic_file.hpp"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <functional>
#include <latch>
#include <memory>
#include <thread>

#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

std::string message_of(const std::function<void()>& act) {
    try {
        act();
    } catch (const IoError& error) {
        return error.what();
    }
    return "no error";
}

TEST(AtomicFile, AppearsAtCommitAndNotBefore) {
    Scratch scratch;
    AtomicFile file(scratch / "a.txt");
    file.write("half");
    EXPECT_FALSE(fs::exists(scratch / "a.txt"));
    file.write(" and half");
    file.commit();
    EXPECT_EQ(read_file(scratch / "a.txt"), "half and half");
    EXPECT_EQ(scratch.names(), Names{"a.txt"});
}

TEST(AtomicFile, LeavesNothingAndTheOldFileWithoutCommit) {
    Scratch scratch;
    write_file(scratch / "a.txt", "old");
    { AtomicFile(scratch / "a.txt").write("new"); }
    EXPECT_EQ(read_file(scratch / "a.txt"), "old");
    EXPECT_EQ(scratch.names(), Names{"a.txt"});
}

TEST(AtomicFile, IsHiddenUntilThen) {
    Scratch scratch;
    AtomicFile file(scratch / "a.txt");
    ASSERT_EQ(scratch.names().size(), 1u);
    EXPECT_EQ(scratch.names()[0].substr(0, 7), ".a.txt.");
    EXPECT_EQ(file.temporary_path().parent_path(), scratch.path());
}

TEST(AtomicFile, TwoWritersOfOneTargetDoNotMix) {
    Scratch scratch;
    AtomicFile first(scratch / "a.txt"), second(scratch / "a.txt");
    first.write("first");
    second.write("second");
    second.commit();
    first.commit();
    EXPECT_EQ(read_file(scratch / "a.txt"), "first");
    EXPECT_EQ(scratch.names(), Names{"a.txt"});
}

TEST(AtomicFile, RespectsTheUmask) {
    Scratch scratch;
    const mode_t before = umask(027);
    write_file(scratch / "a.txt", "x");
    umask(before);
    struct stat status = {};
    ASSERT_EQ(stat((scratch / "a.txt").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, mode_t(0640));
}

TEST(AtomicFile, FollowsALinkInsteadOfReplacingIt) {
    Scratch scratch;
    write_file(scratch / "real.txt", "old");
    fs::create_symlink("real.txt", scratch / "link.txt");
    write_file(scratch / "link.txt", "new");
    EXPECT_TRUE(fs::is_symlink(scratch / "link.txt"));
    EXPECT_EQ(read_file(scratch / "real.txt"), "new");
}

TEST(AtomicFile, MakesTheFileThatADanglingLinkNames) {
    Scratch scratch;
    fs::create_symlink("real.txt", scratch / "link.txt");
    write_file(scratch / "link.txt", "new");
    EXPECT_TRUE(fs::is_symlink(scratch / "link.txt"));
    EXPECT_EQ(read_file(scratch / "real.txt"), "new");
}

// The last part of a path, a folder on the way, and a folder that does not exist yet.
TEST(AtomicFile, NoLinkLeadsItOutOfTheFolderItMustLieIn) {
    Scratch scratch;
    const fs::path folder = scratch / "out", elsewhere = scratch / "elsewhere";
    for (const fs::path& each : {folder / "sub", elsewhere}) fs::create_directories(each);
    fs::create_symlink("../elsewhere", folder / "link");
    fs::create_symlink(elsewhere / "b.txt", folder / "b.txt");
    fs::create_symlink("sub", folder / "inside");
    for (const char* name : {"link/a.txt", "b.txt", "inside/../link/a.txt"}) {
        FileTarget target(folder / name);
        target.within = folder;
        const std::string message = message_of([&] { write_file(target, "x"); });
        EXPECT_NE(message.find("symbolic link leads it out of"), std::string::npos) << name << ": " << message;
        EXPECT_NE(message_of([&] { require_within(folder / name, folder); }), "no error") << name;
    }
    EXPECT_NE(message_of([&] { require_within(folder / "link/new/a.txt", folder); }), "no error");
    EXPECT_TRUE(fs::is_empty(elsewhere));
    FileTarget target(folder / "inside/a.txt");
    target.within = folder;
    write_file(target, "x");
    EXPECT_EQ(read_file(folder / "sub/a.txt"), "x");
    fs::create_directory_symlink(folder, scratch / "alias");  // the folder itself may be a link
    target.within = scratch / "alias";
    EXPECT_EQ(message_of([&] { write_file(target, "y"); }), "no error");
}

// The folder is swapped for a link between the look at it and the rename.
TEST(AtomicFile, ALinkThatAppearsMeanwhileLeadsNowhere) {
    Scratch scratch;
    fs::create_directories(scratch / "out/sub");
    fs::create_directory(scratch / "elsewhere");
    FileTarget target(scratch / "out/sub/a.txt");
    target.within = scratch / "out";
    AtomicFile file(target);
    file.write("x");
    fs::rename(scratch / "out/sub", scratch / "out/moved");
    fs::create_directory_symlink(scratch / "elsewhere", scratch / "out/sub");
    file.commit();
    EXPECT_TRUE(fs::is_empty(scratch / "elsewhere"));
    EXPECT_EQ(read_file(scratch / "out/moved/a.txt"), "x");
}

TEST(AtomicFile, AcceptsTheLongestNameAFileMayHave) {
    Scratch scratch;
    const std::string name(255, 'n');
    write_file(scratch / name, "x");
    EXPECT_EQ(scratch.names(), Names{name});
}

TEST(AtomicFile, NamesTheFileAndTheRemedyWhenTheDirectoryIsMissing) {
    Scratch scratch;
    const fs::path target = scratch / "missing/a.txt";
    const std::string message = message_of([&] { AtomicFile file(target); });
    EXPECT_NE(message.find(target.string()), std::string::npos) << message;
    EXPECT_NE(message.find("make the directory first"), std::string::npos) << message;
}

TEST(AtomicFile, RefusesADirectoryAsTarget) {
    Scratch scratch;
    EXPECT_NE(message_of([&] { AtomicFile file(scratch.path()); }).find("Is a directory"), std::string::npos);
    EXPECT_NE(message_of([&] { AtomicFile file(scratch / ""); }).find("names a directory"), std::string::npos);
}

TEST(AtomicFile, RefusesADevice) {
    EXPECT_NE(message_of([] { AtomicFile file("/dev/null"); }).find("device"), std::string::npos);
}

TEST(AtomicFile, SaysSoInAnUnwritableDirectory) {
    Scratch scratch;
    fs::permissions(scratch.path(), fs::perms::owner_read | fs::perms::owner_exec);
    const int code = exit_code_of([&] {
        constexpr uid_t nobody = 65534;  // root may write anywhere, so it must become somebody else
        if (geteuid() == 0 && seteuid(nobody) != 0) return 2;
        const std::string message = message_of([&] { AtomicFile file(scratch / "a.txt"); });
        return message.find("may write to") != std::string::npos ? 0 : 1;
    });
    EXPECT_EQ(code, 0);
}

// A limit on the file size stands for the full disk: the same path through write(2), without a disk to fill.
TEST(AtomicFile, LeavesNothingWhenTheDiskIsFull) {
    Scratch scratch;
    const int code = exit_code_of([&] {
        install_handlers();
        const rlimit limit = {1000, 1000};
        setrlimit(RLIMIT_FSIZE, &limit);
        const std::string message = message_of([&] { write_file(scratch / "a.txt", std::string(5000, 'x')); });
        return message.find("a.txt: File too large") != std::string::npos ? 0 : 1;
    });
    EXPECT_EQ(code, 0);
    EXPECT_EQ(scratch.names(), Names{});
}

TEST(AtomicFile, IsCommittedOnce) {
    Scratch scratch;
    AtomicFile file(scratch / "a.txt");
    file.commit();
    EXPECT_THROW(file.commit(), std::logic_error);
}

TEST(ReadFile, SaysWhatItCannotRead) {
    Scratch scratch;
    EXPECT_NE(message_of([&] { read_file(scratch / "none"); }).find("No such file or directory; correct its name"),
              std::string::npos);
    EXPECT_NE(message_of([&] { read_file(scratch.path()); }).find("Is a directory"), std::string::npos);
}

TEST(Interrupt, FirstSignalOnlyRaisesTheFlag) {
    Scratch scratch;
    const int code = exit_code_of([&] {
        signal(SIGINT, SIG_DFL);  // whoever runs the tests in the background may have it ignored
        install_handlers();
        AtomicFile file(scratch / "a.txt");
        if (interrupted()) return 1;
        raise(SIGINT);
        return interrupted() && fs::exists(file.temporary_path()) ? 0 : 2;
    });
    EXPECT_EQ(code, 0);
    EXPECT_EQ(scratch.names(), Names{});
}

TEST(Interrupt, SecondSignalRemovesWhatIsHalfWrittenAndEndsWith130) {
    Scratch scratch;
    const int code = exit_code_of([&] {
        signal(SIGTERM, SIG_DFL);
        install_handlers();
        write_file(scratch / "done.txt", "whole");
        AtomicFile file(scratch / "a.txt"), other(scratch / "b.txt");
        raise(SIGTERM);
        raise(SIGTERM);
        return 1;
    });
    EXPECT_EQ(code, 130);
    EXPECT_EQ(scratch.names(), Names{"done.txt"});
}

// Threads of a library, such as those of an encoder, fail together when memory is short.
TEST(Interrupt, ThreadsThatCrashTogetherEndWithTheExitCodeAndNoFiles) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers themselves end if they get no memory";
#endif
    for (int repeat = 0; repeat < 50; ++repeat) {
        Scratch scratch;
        const int code = exit_code_of([&] {
            install_crash_handlers(6);
            const AtomicFile file(scratch / "a.txt");
            std::latch together(9);
            std::vector<std::jthread> threads;
            for (int i = 0; i < 8; ++i)
                threads.emplace_back([&] {
                    together.arrive_and_wait();
                    raise(SIGTRAP);
                });
            const rlimit none_left = {1 << 20, 1 << 20};
            setrlimit(RLIMIT_AS, &none_left);
            together.count_down();
            threads.clear();
            return 1;
        });
        ASSERT_EQ(code, 6);
        ASSERT_EQ(scratch.names(), Names{});
    }
}

TEST(Interrupt, AnIgnoredHangupStaysIgnored) {
    const int code = exit_code_of([] {
        signal(SIGHUP, SIG_IGN);
        install_handlers();
        raise(SIGHUP);
        return interrupted() ? 1 : 0;
    });
    EXPECT_EQ(code, 0);
}

TEST(Interrupt, MoreFilesThanPlacesAreStillRemovedByTheirDestructors) {
    Scratch scratch;
    {
        std::vector<std::unique_ptr<AtomicFile>> files;
        for (int i = 0; i < 100; ++i)
            files.push_back(std::make_unique<AtomicFile>(scratch / ("f" + std::to_string(i))));
        EXPECT_EQ(scratch.names().size(), 100u);
    }
    EXPECT_EQ(scratch.names(), Names{});
}

}  // namespace
}  // namespace beamcam::output
