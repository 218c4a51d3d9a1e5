#include "output/data/point_store.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "output/files/atomic_file.hpp"
#include "output/files/interrupt.hpp"
#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

PointShape shape(std::uint64_t points) { return {points, 3, 5}; }

StoredPoint point(std::uint64_t index) {
    StoredPoint p;
    p.point = index;
    p.kind = 2;
    p.period = static_cast<int>(index) + 1;
    p.exponent = 0.5;
    for (std::uint64_t i = 0; i < 3 * index; ++i) p.samples.push_back(static_cast<double>(i) / 7);
    p.state = {1, 2, static_cast<double>(index)};
    p.failure = index == 2 ? "too slow" : "";
    return p;
}

void expect_same(const StoredPoint& a, const StoredPoint& b) {
    EXPECT_EQ(a.point, b.point);
    EXPECT_EQ(a.period, b.period);
    EXPECT_EQ(a.samples, b.samples);
    EXPECT_EQ(a.state, b.state);
    EXPECT_EQ(a.failure, b.failure);
}

TEST(PointStore, KeepsPointsOverItsEnd) {
    const Scratch scratch;
    const std::filesystem::path file = scratch / "a.part";
    {
        PointStore store(file, shape(5), {"sweep", "about it"});
        for (const std::uint64_t k : {3, 0, 2}) store.add(point(k));
        expect_same(store.read(2), point(2));
    }
    PointStore store(file, shape(5), {"sweep", "about it"});
    EXPECT_EQ(store.count(), 3u);
    EXPECT_FALSE(store.has(1));
    EXPECT_EQ(store.numbers(3), 9u);
    for (const std::uint64_t k : {0, 2, 3}) expect_same(store.read(k), point(k));
    store.remove();
    EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(PointStore, KeepsWhatIsWholeWhereverItIsCutOff) {
    const Scratch scratch;
    const std::filesystem::path file = scratch / "a.part";
    std::vector<std::uintmax_t> sizes;
    {
        PointStore store(file, shape(4), {"sweep", "about it"});
        for (std::uint64_t k = 0; k < 4; ++k) {
            sizes.push_back(std::filesystem::file_size(file));
            store.add(point(k));
        }
    }
    for (std::uintmax_t size = std::filesystem::file_size(file) - 1; size > sizes[0]; size -= 5) {
        std::filesystem::resize_file(file, size);
        PointStore store(file, shape(4), {"sweep", "about it"});
        std::uint64_t whole = 0;
        while (whole + 1 < sizes.size() && sizes[whole + 1] <= size) ++whole;
        ASSERT_EQ(store.count(), whole) << size;
        store.add(point(3));
        expect_same(store.read(3), point(3));
        std::filesystem::resize_file(file, size);
        if (size < sizes[0] + 6) break;
    }
}

TEST(PointStore, DropsADamagedPointAndWhatFollows) {
    const Scratch scratch;
    const std::filesystem::path file = scratch / "a.part";
    std::uintmax_t second = 0;
    {
        PointStore store(file, shape(4), {"sweep", "about it"});
        store.add(point(1));
        second = std::filesystem::file_size(file);
        store.add(point(2));
    }
    std::fstream damage(file, std::ios::in | std::ios::out | std::ios::binary);
    damage.seekp(static_cast<std::streamoff>(second) + 90);
    damage.put('\x55');
    damage.close();
    const PointStore store(file, shape(4), {"sweep", "about it"});
    EXPECT_TRUE(store.has(1));
    EXPECT_FALSE(store.has(2));
}

TEST(PointStore, ReplacesThePointsOfAnotherSweepOnlyWhenAsked) {
    const Scratch scratch;
    const std::filesystem::path file = scratch / "a.part";
    PointStore(file, shape(4), {"one", "about it"}).add(point(1));
    EXPECT_THROW(PointStore(file, shape(4), {"other", "about it"}), IoError);
    EXPECT_EQ(PointStore(file, shape(4), {"one", "about it"}).count(), 1u);
    EXPECT_EQ(PointStore(file, shape(4), {"other", "about it"}, true).count(), 0u);
    EXPECT_EQ(PointStore(file, shape(4), {"one", "about it"}).count(), 0u);  // none are lost
}

TEST(PointStore, LeavesAloneAFileThatIsNoStore) {
    const Scratch scratch;
    for (const std::string text : {"a download", "beamcam points of mine", "beamcam points 2\n"}) {
        write_file(scratch / "a.part", text);
        EXPECT_THROW(PointStore(scratch / "a.part", shape(4), {"sweep", "about it"}), IoError);
        EXPECT_EQ(read_file(scratch / "a.part"), text);
    }
    // The program was killed while it wrote the head.
    write_file(scratch / "a.part", "beamcam po");
    EXPECT_EQ(PointStore(scratch / "a.part", shape(4), {"sweep", "about it"}).count(), 0u);
}

TEST(PointStore, LeavesAFileOnlyIfItHasPoints) {
    const Scratch scratch;
    { const PointStore store(scratch / "a.part", shape(4), {"sweep", "about it"}); }
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.part"));
}

// A limit on the file size stands for the full disk.
TEST(PointStore, KeepsThePointsThatAFullDiskHasRoomFor) {
    for (const rlim_t room : {1, 100, 1000}) {
        const Scratch scratch;
        const int code = exit_code_of([&] {
            install_handlers();
            const rlimit limit = {room, room};
            setrlimit(RLIMIT_FSIZE, &limit);
            try {
                PointStore store(scratch / "a.part", shape(400), {"sweep", "about it"});
                for (std::uint64_t k = 0; k < 400; ++k) store.add(point(k));
            } catch (const IoError& full) {
                return std::string(full.what()).find("a.part: File too large; ") != std::string::npos ? 0 : 1;
            }
            return 2;
        });
        EXPECT_EQ(code, 0) << room;
        EXPECT_EQ(std::filesystem::exists(scratch / "a.part"), room == 1000);
    }
}

TEST(PointStore, TakesPointsOfManyThreads) {
    const Scratch scratch;
    constexpr std::uint64_t kEach = 200;
    PointStore store(scratch / "a.part", shape(4 * kEach), {"sweep", "about it"});
    std::vector<std::thread> threads;
    for (std::uint64_t thread = 0; thread < 4; ++thread)
        threads.emplace_back([&store, thread] {
            for (std::uint64_t k = 0; k < kEach; ++k) store.add(point(4 * k + thread));
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(store.count(), 4 * kEach);
    for (std::uint64_t k = 0; k < 4 * kEach; ++k) expect_same(store.read(k), point(k));
}

TEST(PointStore, KeepsItsPointsWhenItsNameIsGone) {
    const Scratch scratch;
    PointStore store(scratch / "a.part", shape(4), {"sweep", "about it"});
    store.remove();
    store.add(point(3));
    expect_same(store.read(3), point(3));
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.part"));
}

TEST(PointStore, IsOfOneProgramAtATime) {
    const Scratch scratch;
    const PointStore store(scratch / "a.part", shape(4), {"sweep", "about it"});
    EXPECT_THROW(PointStore(scratch / "a.part", shape(4), {"sweep", "about it"}), IoError);
}

}  // namespace
}  // namespace beamcam::output
