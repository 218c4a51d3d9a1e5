#include "output/data/agreement.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace beamcam::output {
namespace {

TEST(Agreement, CountsRowsWithBothValuesWhereTheMotionIsReproducible) {
    sim::Result result;
    result.not_reproducible = {{3, 4}};
    const double nan = std::nan("");
    const Agreement a =
        agreement({0, 1, 1.5, 2, 2.5, 3.5, 3.9, 4.5}, {1, 2, 3, nan, 5, 10, 20, 7}, {1, 1, 1, 1, 9, 30, 30, 7}, result);
    EXPECT_EQ(a.rows, 5u);
    EXPECT_DOUBLE_EQ(a.rms, std::sqrt((0 + 1 + 4 + 16 + 0) / 5.0));
}

TEST(Agreement, WithoutRowsSaysNothing) { EXPECT_EQ(agreement({}, {}, {}, {}).rows, 0u); }

}  // namespace
}  // namespace beamcam::output
