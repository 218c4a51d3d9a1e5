#include "output/files/spool.hpp"

#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

std::vector<std::byte> bytes(std::size_t count, int first) {
    std::vector<std::byte> all(count);
    for (std::size_t i = 0; i < count; ++i) all[i] = static_cast<std::byte>(first + static_cast<int>(i));
    return all;
}

// In pieces of 100 bytes, the even ones first, one of them twice.
void write_all(Spool& spool, const std::vector<std::byte>& all) {
    const std::span<const std::byte> from(all);
    spool.write(200, bytes(100, 77));
    for (std::size_t odd : {0U, 1U})
        for (std::size_t at = 100 * odd; at < all.size(); at += 200) spool.write(at, from.subspan(at, 100));
}

std::vector<std::byte> read(const Spool& spool, std::size_t size) {
    std::vector<std::byte> all(size);
    spool.read(0, all);
    return all;
}

class Temporary {
  public:
    explicit Temporary(const std::filesystem::path& directory) {
        if (const char* now = std::getenv("TMPDIR")) before_ = now;
        setenv("TMPDIR", directory.c_str(), 1);
    }
    ~Temporary() { before_ ? setenv("TMPDIR", before_->c_str(), 1) : unsetenv("TMPDIR"); }

  private:
    std::optional<std::string> before_;
};

TEST(Spool, GivesBackWhatItWasGivenInMemoryAndOnDisk) {
    const Scratch scratch;
    const Temporary here(scratch.path());
    const std::vector<std::byte> all = bytes(10'000, 3);
    for (std::size_t held : {20'000U, 9'999U, 1'000U, 0U}) {
        const std::ptrdiff_t open_before = open_files();
        Spool spool(held);
        write_all(spool, all);
        EXPECT_EQ(open_files() - open_before, held < all.size() ? 1 : 0) << held;
        EXPECT_EQ(read(spool, all.size()), all) << held;
        std::vector<std::byte> part(7);
        spool.read(4'321, part);
        EXPECT_TRUE(std::ranges::equal(part, std::span(all).subspan(4'321, 7)));
        EXPECT_TRUE(std::filesystem::is_empty(scratch.path()));  // its file has no name
    }
}

TEST(Spool, WhatWasNeverWrittenIsZero) {
    for (std::size_t held : {0U, 1'000U}) {
        Spool spool(held);
        spool.write(50, bytes(10, 1));
        std::vector<std::byte> seen(100, std::byte{9});
        spool.read(0, seen);
        EXPECT_EQ(std::ranges::count(seen, std::byte{0}), 90);
    }
}

// In a process of its own: no file may grow beyond 4096 bytes there.
TEST(Spool, AFullDiskLeavesAllInMemory) {
    const Scratch scratch;
    const Temporary here(scratch.path());
    const std::vector<std::byte> all = bytes(10'000, 3);
    const pid_t child = fork();
    if (child == 0) {
        signal(SIGXFSZ, SIG_IGN);
        const rlimit small{4'096, 4'096};
        setrlimit(RLIMIT_FSIZE, &small);
        const std::ptrdiff_t open_before = open_files();
        Spool spool(1'000);
        write_all(spool, all);
        _exit(open_files() == open_before && read(spool, all.size()) == all ? 0 : 1);
    }
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace beamcam::output
