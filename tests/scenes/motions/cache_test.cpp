#include "scenes/motions/cache.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <numeric>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;
using testing::Folder;

constexpr std::uintmax_t kMiB = 1 << 20;

std::string key(char digit) { return std::string(64, digit); }

std::vector<double> numbers(std::size_t count) {
    std::vector<double> all(count);
    std::iota(all.begin(), all.end(), 0.5);
    return all;
}

std::optional<std::vector<double>> loaded(const Cache& cache, char digit, double end) {
    const auto kept = cache.load(key(digit), end);
    if (!kept) return std::nullopt;
    std::vector<double> all(kept->size());
    kept->read(0, all);
    return all;
}

bool keep(const Cache& cache, char digit, double end, std::size_t count) {
    Cache::Entry entry(cache, key(digit));
    const std::vector<double> all = numbers(count);
    const std::span<const double> span(all);
    entry.add(span.first(count / 3));
    entry.add(span.subspan(count / 3));
    return entry.commit(end, 7, "about it");
}

TEST(Cache, GivesBackWhatItWasGiven) {
    const Folder folder;
    const Cache cache(folder / "c", 10 * kMiB);
    EXPECT_FALSE(cache.reach(key('a')));
    EXPECT_TRUE(keep(cache, 'a', 1.5, 1000));
    EXPECT_EQ(cache.reach(key('a')), 1.5);
    EXPECT_EQ(loaded(cache, 'a', 1.5), numbers(1000));
    EXPECT_EQ(loaded(cache, 'a', 0.3), numbers(1000));
    EXPECT_FALSE(cache.load(key('a'), 1.6));
    EXPECT_FALSE(cache.load(key('b'), 0.3));
    ASSERT_EQ(cache.list().size(), 1u);
    EXPECT_EQ(cache.list()[0].about, "about it");
    EXPECT_EQ(cache.list()[0].steps, 7);
    EXPECT_EQ(cache.clear().first, 1);
    EXPECT_TRUE(cache.list().empty());
}

TEST(Cache, ALongerEntryReplacesAShorterAndNeverTheOtherWay) {
    const Folder folder;
    const Cache cache(folder / "c", 10 * kMiB);
    EXPECT_TRUE(keep(cache, 'a', 1, 100));
    EXPECT_TRUE(keep(cache, 'a', 2, 200));
    EXPECT_FALSE(keep(cache, 'a', 1.5, 150));
    EXPECT_EQ(loaded(cache, 'a', 1), numbers(200));
}

TEST(Cache, AnEntryThatIsNotCommittedLeavesNothing) {
    const Folder folder;
    const Cache cache(folder / "c", 10 * kMiB);
    {
        Cache::Entry entry(cache, key('a'));
        entry.add(numbers(10));
    }
    EXPECT_TRUE(fs::is_empty(folder / "c"));
}

TEST(Cache, RemovesWhatWasUsedLongestAgoWhenItIsFull) {
    const Folder folder;
    const Cache cache(folder / "c", kMiB);
    const std::size_t third = kMiB / 8 / 3 - 100;
    const auto now = fs::file_time_type::clock::now();
    for (const char digit : {'a', 'b', 'c'}) EXPECT_TRUE(keep(cache, digit, 1, third));
    // Used in the order b, c, a.
    fs::last_write_time(folder / ("c/" + key('b') + ".trajectory"), now - std::chrono::hours(3));
    fs::last_write_time(folder / ("c/" + key('c') + ".trajectory"), now - std::chrono::hours(2));
    fs::last_write_time(folder / ("c/" + key('a') + ".trajectory"), now - std::chrono::hours(4));
    EXPECT_TRUE(cache.load(key('a'), 1));  // used now
    EXPECT_TRUE(keep(cache, 'd', 1, third));
    EXPECT_TRUE(cache.reach(key('a')));
    EXPECT_FALSE(cache.reach(key('b')));
    EXPECT_TRUE(cache.reach(key('c')));
    EXPECT_TRUE(cache.reach(key('d')));
}

TEST(Cache, KeepsNothingThatWouldFillHalfOfIt) {
    const Folder folder;
    const Cache cache(folder / "c", kMiB);
    EXPECT_FALSE(keep(cache, 'a', 1, kMiB / 8 * 6 / 10));
    EXPECT_TRUE(cache.list().empty());
    const Cache none(folder / "d", 0);
    EXPECT_FALSE(keep(none, 'a', 1, 10));
    EXPECT_FALSE(fs::exists(folder / "d"));
}

TEST(Cache, SweepsHalfWrittenFilesThatNobodyTouchesAnyMore) {
    const Folder folder;
    const Cache cache(folder / "c", kMiB);
    fs::create_directory(folder / "c");
    const fs::path dead = folder / ("c/." + key('a') + ".trajectory.0123abcd.part"),
                   alive = folder / ("c/." + key('b') + ".trajectory.0123abcd.part");
    std::ofstream(dead) << "half";
    std::ofstream(alive) << "half";
    fs::last_write_time(dead, fs::file_time_type::clock::now() - std::chrono::hours(2));
    EXPECT_TRUE(keep(cache, 'c', 1, 100));
    EXPECT_FALSE(fs::exists(dead));
    EXPECT_TRUE(fs::exists(alive));
}

TEST(Cache, ADamagedEntryIsNoneWhereverItIsDamaged) {
    const Folder folder;
    const Cache cache(folder / "c", kMiB);
    EXPECT_TRUE(keep(cache, 'a', 1, 300));
    const fs::path file = folder / ("c/" + key('a') + ".trajectory");
    const std::string whole = testing::slurp(file);
    for (std::size_t at = 0; at < whole.size(); at += 13) {
        std::string bent = whole;
        bent[at] = static_cast<char>(bent[at] ^ 0x10);
        std::ofstream(file, std::ios::binary) << bent;
        EXPECT_FALSE(cache.load(key('a'), 1)) << at;
    }
    for (std::size_t size = 0; size < whole.size(); size += 37) {
        std::ofstream(file, std::ios::binary) << whole.substr(0, size);
        EXPECT_FALSE(cache.load(key('a'), 1)) << size;
    }
    std::ofstream(file, std::ios::binary) << whole;
    EXPECT_TRUE(cache.load(key('a'), 1));
}

}  // namespace
}  // namespace beamcam::scenes
