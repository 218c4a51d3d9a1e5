#include "scenes/motions/fan_out.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace beamcam::scenes {
namespace {

TEST(FanOut, CallsEachNumberOnceAndLetsThemThroughInOrder) {
    for (const ThreadCounts& threads : {ThreadCounts{1, 1}, ThreadCounts{3, 3}, ThreadCounts{1, 4, [] { return true; }},
                                        ThreadCounts{2, 4, [] { return false; }}}) {
        OrderedGate gate;
        std::vector<long> passed;
        const int worked = fan_out(
            500, threads, [&]() -> Worker { return [&](long k) { gate.pass(k, [&] { passed.push_back(k); }); }; },
            gate);
        ASSERT_EQ(passed.size(), 500u);
        for (long k = 0; k < 500; ++k) EXPECT_EQ(passed[static_cast<std::size_t>(k)], k);
        EXPECT_GE(worked, threads.first);
        EXPECT_LE(worked, threads.most);
    }
}

TEST(FanOut, StartsAnotherThreadOnlyWhereItHelps) {
    std::atomic<int> calls{0};
    const auto threads_of = [&](int yes_from, int yes_until) {
        return ThreadCounts{1, 8, [&calls, yes_from, yes_until] {
                                const int time = ++calls;
                                return time >= yes_from && time < yes_until;
                            }};
    };
    OrderedGate gate;
    std::mutex mutex;
    std::set<std::thread::id> threads;
    const auto note = [&]() -> Worker {
        const std::lock_guard lock(mutex);
        threads.insert(std::this_thread::get_id());
        return [](long) {};
    };
    EXPECT_EQ(fan_out(100, threads_of(1000, 0), note, gate), 1);
    EXPECT_EQ(threads, std::set{std::this_thread::get_id()});
    calls = 0;
    threads.clear();
    EXPECT_EQ(fan_out(100, threads_of(10, 12), note, gate), 3);
    EXPECT_EQ(threads.size(), 3u);
    // No more than there are numbers, however often it would help.
    calls = 0;
    EXPECT_LE(fan_out(2, threads_of(1, 1000), note, gate), 2);
    EXPECT_EQ(fan_out(0, threads_of(1, 1000), note, gate), 1);
}

TEST(FanOut, TheFirstFailureEndsTheWork) {
    for (const ThreadCounts& threads :
         {ThreadCounts{1, 1}, ThreadCounts{4, 4}, ThreadCounts{1, 4, [] { return true; }}}) {
        OrderedGate gate;
        std::atomic<long> called{0};
        const auto fail = [&]() -> Worker {
            return [&](long k) {
                ++called;
                gate.pass(k, [&] {
                    if (k == 20) throw std::runtime_error("number 20");
                });
            };
        };
        try {
            fan_out(100000, threads, fail, gate);
            FAIL();
        } catch (const std::runtime_error& error) {
            EXPECT_STREQ(error.what(), "number 20");
        }
        EXPECT_LT(called, 100000);
    }
}

}  // namespace
}  // namespace beamcam::scenes
