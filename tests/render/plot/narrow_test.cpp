#include "render/plot/narrow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace beamcam::render {
namespace {

double highest(const std::vector<Vec2>& pieces) {
    double most = 0;
    for (const Vec2 p : pieces)
        if (std::isfinite(p.y)) most = std::max(most, p.y);
    return most;
}

// The spike is 2 wide and 100 high; the period of the dashes is 10.
TEST(Spikes, AreDrawnWithoutDashes) {
    std::vector<Vec2> points;
    for (int x = 0; x <= 200; ++x) points.push_back({double(x), x == 100 ? 100.0 : 0.0});
    const DashedCurve pieces = without_dashes_in_spikes(points, 10);
    EXPECT_EQ(highest(pieces.solid), 100);
    EXPECT_EQ(highest(pieces.dashed), 0);
    const auto [left, right] =
        std::ranges::minmax(pieces.solid, {}, [](Vec2 p) { return std::isfinite(p.x) ? p.x : 100; });
    EXPECT_GT(left.x, 90);
    EXPECT_LT(right.x, 110);
}

TEST(Spikes, WideCurvesAndLoopsStayDashed) {
    std::vector<Vec2> wave, loop, pulse, step;  // the pulse is as wide as a dash; the step does not come back
    for (int i = 0; i <= 200; ++i) {
        wave.push_back({double(i), 20 * std::sin(i * 0.05)});
        loop.push_back({50 * std::cos(i * 0.1), 50 * std::sin(i * 0.1)});
        pulse.push_back({double(i), 200 * std::exp(-std::pow((i - 100) / 5.0, 2))});
        step.push_back({double(i), i < 100 ? 0.0 : 100.0});
    }
    for (const auto* curve : {&wave, &loop, &pulse, &step}) {
        const DashedCurve pieces = without_dashes_in_spikes(*curve, 10);
        EXPECT_TRUE(pieces.solid.empty());
        EXPECT_EQ(pieces.dashed.size(), curve->size());
    }
}

TEST(Spikes, GapsSeparatePieces) {
    const double nan = std::nan("");
    const DashedCurve pieces = without_dashes_in_spikes({{0, 0}, {1, 0}, {nan, nan}, {3, 0}, {4, 0}}, 10);
    ASSERT_EQ(pieces.dashed.size(), 5U);
    EXPECT_TRUE(std::isnan(pieces.dashed[2].x));
}

}  // namespace
}  // namespace beamcam::render
