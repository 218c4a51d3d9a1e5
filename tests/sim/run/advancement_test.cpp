// Conservative advancement against parabolas.
#include "sim/run/advancement.hpp"

#include <gtest/gtest.h>

namespace beamcam::sim {
namespace {

TEST(Advancement, EndsWhereAParabolaTouches) {
    const double inf = std::numeric_limits<double>::infinity();
    for (const double pull : {0.0, 1e-30, 3.0, 1e8})
        for (const double g : {0.0, 1e-16, 2.0})
            for (const double v : {-5.0, -1e-9, 0.0, 1e-9, 5.0}) {
                const Advancement gap{pull, pull};
                const double t = gap.clear_time(g, v);
                ASSERT_GE(t, 0) << pull << " " << g << " " << v;
                if (t < inf) {
                    EXPECT_NEAR(g + v * t - 0.5 * pull * t * t, 0, 1e-12 * (g + std::fabs(v) * t));
                } else {
                    EXPECT_TRUE(v >= 0 && !(pull > 1)) << pull << " " << g << " " << v;
                }
                const auto certain = gap.certain_time(g, v);
                EXPECT_EQ(certain.has_value(), v < 0 && v * v > 2 * pull * g) << pull << " " << g << " " << v;
                if (!certain) continue;
                EXPECT_GE(*certain, t);
                EXPECT_NEAR(g + v * *certain + 0.5 * pull * *certain * *certain, 0, 1e-12 * (g - v * *certain));
            }
}

TEST(Advancement, IsNotEndedByAGapThatIsSureToOpenOrToFallFaster) {
    EXPECT_EQ((Advancement{-2, 5}.clear_time(1, 0)), std::numeric_limits<double>::infinity());
    // g̈ <= −2: the touch is certain by the root of 1 − τ − τ².
    EXPECT_NEAR((Advancement{5, -2}.certain_time(1, -1).value()), 0.5 * (std::sqrt(5.0) - 1), 1e-15);
}

}  // namespace
}  // namespace beamcam::sim
