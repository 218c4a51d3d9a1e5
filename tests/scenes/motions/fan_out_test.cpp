#include "scenes/motions/fan_out.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <vector>

namespace beamcam::scenes {
namespace {

TEST(FanOut, CallsEachNumberOnceAndLetsThemThroughInOrder) {
    for (const int threads : {1, 3, 1000}) {
        OrderedGate gate;
        std::vector<long> passed;
        const int worked = fan_out(
            500, threads, [&]() -> Worker { return [&](long k) { gate.pass(k, [&] { passed.push_back(k); }); }; },
            gate);
        ASSERT_EQ(passed.size(), 500u);
        for (long k = 0; k < 500; ++k) EXPECT_EQ(passed[static_cast<std::size_t>(k)], k);
        EXPECT_GE(worked, 1);
        EXPECT_LE(worked, std::min(threads, 500));
    }
}

TEST(FanOut, TheFirstFailureEndsTheWork) {
    for (const int threads : {1, 4}) {
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
