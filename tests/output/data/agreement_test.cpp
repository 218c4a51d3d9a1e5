#include "output/data/agreement.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace beamcam::output {
namespace {

TEST(Agreement, IsCountedByCollisionsAndOnlyWhereTheMotionIsReproducible) {
    sim::Result result;
    result.collisions.resize(2);
    result.collisions[0].t_start = 1, result.collisions[1].t_start = 2;
    result.not_reproducible = {{3, 4}};
    const double nan = std::nan("");
    const Agreement a =
        agreement({0, 1, 1.5, 2, 2.5, 3.5, 3.9, 4.5}, {1, 2, 3, nan, 5, 10, 20, 7}, {1, 1, 1, 1, 9, 30, 30, 7}, result);
    EXPECT_EQ(a.whole.rows, 5u);
    EXPECT_DOUBLE_EQ(a.whole.rms, std::sqrt((0 + 1 + 4 + 16 + 0) / 5.0));
    EXPECT_EQ(a.whole.largest, -4);
    EXPECT_EQ(a.whole.t_largest, 2.5);
    EXPECT_EQ(a.whole.highest, 7 - 9);
    ASSERT_EQ(a.collisions.size(), 2u);
    EXPECT_EQ(a.collisions[0].rows, 2u);
    EXPECT_DOUBLE_EQ(a.collisions[0].rms, std::sqrt(2.5));
    EXPECT_EQ(a.collisions[1].collision, 2);
    EXPECT_EQ(a.collisions[1].rows, 2u);  // one at 2.5, one behind the interval
    ASSERT_TRUE(a.beyond);
    EXPECT_EQ(a.beyond->rows, 2u);
    EXPECT_EQ(a.beyond->measured.mean, 15);
    EXPECT_EQ(a.beyond->measured.deviation, 5);
    EXPECT_EQ(a.beyond->computed.mean, 30);
}

TEST(Agreement, WithoutRowsSaysNothing) {
    const Agreement a = agreement({}, {}, {}, {});
    EXPECT_EQ(a.whole.rows, 0u);
    EXPECT_FALSE(a.beyond);
}

}  // namespace
}  // namespace beamcam::output
