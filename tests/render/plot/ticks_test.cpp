#include "render/plot/ticks.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "render/draw/canvas.hpp"
#include "render/plot/plot.hpp"

namespace beamcam::render {
namespace {

TEST(Ticks, RoundNumbersAreOneTwoOrFiveTimesAPowerOfTen) {
    EXPECT_DOUBLE_EQ(round_down_125(0.99), 0.5);
    EXPECT_DOUBLE_EQ(round_down_125(1), 1);
    EXPECT_DOUBLE_EQ(round_down_125(4999), 2000);
    EXPECT_DOUBLE_EQ(round_down_125(0.0021), 0.002);
    EXPECT_DOUBLE_EQ(round_up_125(0.99), 1);
    EXPECT_DOUBLE_EQ(round_up_125(5), 5);
    EXPECT_DOUBLE_EQ(round_up_125(5.01), 10);
    EXPECT_DOUBLE_EQ(round_up_125(2.1e-7), 5e-7);
}

TEST(Ticks, RoundingUpAndDownMeetAtRoundNumbersOfAnySize) {
    for (int n = -15; n <= 15; ++n)
        for (double m : {1.0, 2.0, 5.0}) {
            const double value = m * std::pow(10.0, n);
            EXPECT_NEAR(round_down_125(value) / value, 1, 1e-12) << value;
            EXPECT_NEAR(round_up_125(value) / value, 1, 1e-12) << value;
        }
}

TEST(Ticks, MarksAreMultiplesOfTheStepWithinTheRangeAndNoMoreThanAsked) {
    for (double low : {-3.7, 0.0, 12.3})
        for (double span : {1e-3, 0.7, 9.0, 12345.0})
            for (int most : {2, 3, 5, 8}) {
                const Ticks t = ticks(low, low + span, most);
                EXPECT_LE(static_cast<int>(t.values.size()), most);
                for (double v : t.values) {
                    EXPECT_NEAR(v / t.step, std::round(v / t.step), 1e-6);
                    EXPECT_GE(v, low - 1e-8 * t.step);
                    EXPECT_LE(v, low + span + 1e-8 * t.step);
                }
            }
}

TEST(Ticks, DecimalsTellNeighboursApart) {
    EXPECT_EQ(ticks(0, 1, 6).decimals, 1);
    EXPECT_EQ(ticks(0, 100, 6).decimals, 0);
    EXPECT_EQ(ticks(0.2, 0.26, 4).decimals, 2);
    EXPECT_EQ(fixed(0.2, 1), "0.2");
}

TEST(Ticks, NegativeNumbersHaveATrueMinusAndZeroHasNone) {
    EXPECT_EQ(fixed(-1.25, 1), "−1.2");
    EXPECT_EQ(fixed(-0.01, 1), "0.0");
}

TEST(Quantity, ChoosesTheSiPrefix) {
    EXPECT_EQ(reading(1.9e6, {"M", 1e6}, "N"), "1.90\u00A0MN");  // beside 2.95 MN
    EXPECT_EQ(reading(2.95e6, {"M", 1e6}, "N"), "2.95\u00A0MN");
    EXPECT_EQ(reading(100, {"", 1}, "N"), "100\u00A0N");
    EXPECT_EQ(reading(-12, {"", 1}, "N"), "−12.0\u00A0N");
    EXPECT_EQ(reading(999.7, {"", 1}, "N"), "1000\u00A0N");
    EXPECT_EQ(reading(126, {"k", 1e3}, "N"), "0.126\u00A0kN");  // beside 1.30 kN
    EXPECT_EQ(reading(0, {"", 1}, "N"), "0\u00A0N");
    EXPECT_EQ(quantity(0.02, "m"), "20\u00A0mm");
    EXPECT_EQ(quantity(1, "m"), "1\u00A0m");
    EXPECT_EQ(quantity(100, "m"), "100\u00A0m");
    EXPECT_EQ(quantity(1.5e-6, "m"), "1.5\u00A0µm");
    EXPECT_EQ(quantity(12345, "N"), "12.3\u00A0kN");
    EXPECT_EQ(quantity(-2, "rad/s"), "−2\u00A0rad/s");
    EXPECT_EQ(quantity(0, "m"), "0\u00A0m");
}

TEST(Quantity, ValuesBesideEachOtherShareAPrefix) {
    EXPECT_EQ(quantity(500, prefix_for(2000), "N"), "0.5\u00A0kN");
    EXPECT_EQ(quantity(250, prefix_for(1000), "N"), "0.25\u00A0kN");
    EXPECT_EQ(quantity(125, prefix_for(500), "N"), "125\u00A0N");
}

// Numbers that the name or another number would touch are left out; the name is between the last two if fewer than two
// would remain, and left of all if there is no room.
TEST(Ticks, TheNameOfTheAxisIsAtItsRightEnd) {
    const Palette& p = palette(Theme::light);
    const Fonts fonts(false);
    for (const auto& [width, from] : {std::pair{600.0, 0.0}, {200.0, 0.0}, {130.0, -1.0}, {40.0, 0.0}}) {
        Image image(800, 100);
        Canvas canvas(image, fonts);
        std::vector<Box> texts;
        canvas.record = &texts;
        const Box plot{50, 10, width, 50};
        const figure::PlotStyle style = figure::film_style(p, 1, 21, 17);
        figure::Panel panel{.x = {.label = "$t$ / s", .from = from, .to = 1, .unit = 1}, .y = {.from = 0, .to = 1}};
        figure::Plot axes(panel, style, "test");
        axes.place(canvas, plot);
        axes.draw_x_axis(canvas);
        ASSERT_GE(texts.size(), 2U);
        for (std::size_t i = 0; i < texts.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(texts[i].overlaps(texts[j])) << i << ", " << j;
        if (width > 200) {
            EXPECT_NEAR(texts.back().right(), plot.right() + 8, 2);
        } else if (width > 150) {
            EXPECT_LT(texts.back().right(), texts[texts.size() - 2].x);
        } else if (width < 100) {
            EXPECT_LT(texts.back().right(), texts.front().x - 10);
        }
    }
}

}  // namespace
}  // namespace beamcam::render
