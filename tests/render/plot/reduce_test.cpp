#include "render/plot/reduce.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace beamcam::render {
namespace {

TEST(FigureReduce, AMillionPointsKeepTheirExtremes) {
    std::vector<Vec2> points;
    for (int i = 0; i < 1'000'000; ++i) points.push_back({i * 2e-4, std::sin(i * 0.01)});
    points[123456].y = 50;
    const std::vector<Vec2> kept = reduce(points, 0.1);
    EXPECT_LT(kept.size(), 9000u);
    double most = 0;
    for (const Vec2 p : kept) most = std::max(most, p.y);
    EXPECT_EQ(most, 50);
    EXPECT_EQ(kept.front(), points.front());
    EXPECT_EQ(kept.back(), points.back());
}

TEST(FigureReduce, ASlowCurveStaysRound) {
    std::vector<Vec2> points;
    for (int i = 0; i <= 100'000; ++i) points.push_back({i * 2e-3, 40 * std::cos(i * 2e-3 / 50)});  // slope below 1
    const double grain = 0.1;
    const std::vector<Vec2> kept = reduce(points, grain);
    EXPECT_LT(kept.size(), 3000u);
    std::size_t k = 0;
    for (const Vec2 p : points) {
        while (kept[k + 1].x < p.x) ++k;
        const double share = (p.x - kept[k].x) / (kept[k + 1].x - kept[k].x);
        ASSERT_NEAR(kept[k].y + share * (kept[k + 1].y - kept[k].y), p.y, 0.5 * grain) << p.x;
    }
}

TEST(FigureReduce, ColumnsKeepTheirExtremes) {
    std::vector<Vec2> points;
    for (int i = 0; i < 100000; ++i) points.push_back({i / 1000.0, std::sin(i * 0.37) * i});
    points[54321].y = 1e7;
    const std::vector<Vec2> kept = column_extremes(points, 1);
    EXPECT_LE(kept.size(), 4U * 101);
    double most = 0;
    for (Vec2 p : kept) most = std::max(most, p.y);
    EXPECT_EQ(most, 1e7);
    for (std::size_t i = 1; i < kept.size(); ++i) EXPECT_GE(kept[i].x, kept[i - 1].x);
}

TEST(FigureReduce, NanBreaksTheLine) {
    const double nan = std::nan("");
    const std::vector<Vec2> kept = reduce(std::vector<Vec2>{{nan, 0}, {0, 0}, {1, nan}, {2, 1}, {3, 5}}, 0.01);
    ASSERT_EQ(kept.size(), 4u);
    EXPECT_TRUE(std::isnan(kept[1].x));
}

// 40 oscillations a column: the outline is the envelope, and little else is left to draw.
TEST(FigureReduce, FastOscillationsBecomeABandWithTheirEnvelope) {
    const auto envelope = [](double x) { return 10 + 5 * std::exp(-x / 60); };
    std::vector<Vec2> points;
    for (int i = 0; i < 1'000'000; ++i)
        points.push_back({i * 1e-4, i % 7 == 3 ? std::nan("") : envelope(i * 1e-4) * std::sin(i * 0.0251327)});
    const std::vector<Envelope> fast = envelopes(points, 1);
    ASSERT_EQ(fast.size(), 1u);
    EXPECT_EQ(fast[0].least.size(), 100u);
    EXPECT_EQ(fast[0].first, 0u);
    EXPECT_EQ(fast[0].last, points.size() - 1);
    for (std::size_t column = 0; column < 100; ++column) {
        const Vec2 crest = points[fast[0].most[column]], trough = points[fast[0].least[column]];
        EXPECT_EQ(std::floor(crest.x), column);
        EXPECT_EQ(std::floor(trough.x), column);
        EXPECT_NEAR(crest.y, envelope(crest.x), 0.01);
        EXPECT_NEAR(trough.y, -envelope(trough.x), 0.01);
    }
    EXPECT_EQ(outline(fast[0], points).size(), 202u);
    const std::vector<Vec2> rest = without(fast, points);
    ASSERT_EQ(rest.size(), 3u);
    EXPECT_TRUE(rest.front() == points.front() && broken(rest[1]) && rest.back() == points.back());
}

TEST(FigureReduce, CurvesThatCanBeToldApartAreNoBands) {
    std::vector<Vec2> slow, orbit, apart;
    for (int i = 0; i < 100'000; ++i) {
        const double t = i * 1e-3;
        slow.push_back({t, std::sin(3 * t)});  // half an oscillation a column
        orbit.push_back({std::cos(500 * t), std::sin(500 * t)});
        apart.push_back({std::floor(t) * 2 + t - std::floor(t), std::sin(500 * t)});  // every second column
    }
    EXPECT_TRUE(envelopes(slow, 1).empty());
    EXPECT_TRUE(envelopes(orbit, 1).empty());
    EXPECT_TRUE(envelopes(apart, 1).empty());
    EXPECT_TRUE(envelopes({}, 1).empty());
}

}  // namespace
}  // namespace beamcam::render
