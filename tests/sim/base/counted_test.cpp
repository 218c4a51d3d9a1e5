#include "sim/base/counted.hpp"

#include <gtest/gtest.h>

namespace beamcam {
namespace {

TEST(Counted, NounsAgreeWithTheirNumber) {
    EXPECT_EQ(counted(0, "impact"), "0 impacts");
    EXPECT_EQ(counted(1, "impact"), "1 impact");
    EXPECT_EQ(counted(2, "impact"), "2 impacts");
    EXPECT_EQ(counted(1, "entry"), "1 entry");
    EXPECT_EQ(counted(3, "entry"), "3 entries");
}

}  // namespace
}  // namespace beamcam
