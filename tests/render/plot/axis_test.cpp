#include "render/plot/axis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/base/error.hpp"
#include "render/draw/markup.hpp"

namespace beamcam::render {
namespace {

using ::testing::HasSubstr;

std::vector<std::string> labels(const AxisMap& axis) {
    std::vector<std::string> out;
    for (const Tick& t : axis.ticks())
        if (!t.label.empty()) out.push_back(to_plain(t.label));
    return out;
}

AxisMap axis(double low, double high, Axis wanted = {}) {
    Extent data;
    data.add(std::vector{low, high}, wanted.scale);
    return {wanted, data, 6, "test"};
}

TEST(FigureAxis, TicksAreRoundAndSayTheirDecimals) {
    EXPECT_THAT(labels(axis(0, 0.4, {.tight = true})), ::testing::ElementsAre("0.0", "0.1", "0.2", "0.3", "0.4"));
    EXPECT_THAT(labels(axis(-2, 7)), ::testing::ElementsAre("−2", "0", "2", "4", "6"));
    EXPECT_THAT(labels(axis(-30, 400, {.label = "$θ$ / °"})), ::testing::ElementsAre("0", "90", "180", "270", "360"));
    EXPECT_THAT(labels(axis(0, 90, {.label = "$θ$ / °"})), ::testing::ElementsAre("0", "20", "40", "60", "80"));
    EXPECT_DOUBLE_EQ(axis(0, 10, {.tight = true}).place(2.5), 0.25);
}

TEST(FigureAxis, ReversedLimitsTurnTheAxisRound) {
    const AxisMap a = axis(0, 1, {.from = 10, .to = 0});
    EXPECT_DOUBLE_EQ(a.place(10), 0);
    EXPECT_DOUBLE_EQ(a.place(0), 1);
}

TEST(FigureAxis, AnyFiniteRangeIsShown) {
    constexpr double kMost = std::numeric_limits<double>::max(), kLeast = std::numeric_limits<double>::denorm_min();
    for (const auto& [low, high] : {std::pair{1e-300, 2e-300},
                                    {1e300, 2e300},
                                    {-1e300, 1e300},
                                    {-kMost, kMost},
                                    {kLeast, 3 * kLeast},
                                    {0.0, kLeast},
                                    {5.0, 5.0},
                                    {0.0, 0.0},
                                    {1e300, 1e300},
                                    {1e8, 1e8 + 1e-3},
                                    {1.0, std::nextafter(1.0, 2.0)},
                                    {-1e-300, 1e300}}) {
        const AxisMap a = axis(low, high);
        EXPECT_GE(labels(a).size(), 2u) << low << " " << high;
        EXPECT_LE(labels(a).size(), 8u);
        EXPECT_TRUE(std::isfinite(a.place(low)) && std::isfinite(a.place(high))) << low << " " << high;
        EXPECT_LE(a.place(low), a.place(high));
        for (const Tick& t : a.ticks())
            EXPECT_TRUE(t.at >= -1e-6 && t.at <= 1 + 1e-6) << low << " " << high << " " << t.at;
        for (const std::string& text : labels(a)) EXPECT_LE(text.size(), 14u) << text;
    }
    EXPECT_THAT(axis(1e300, 2e300).common(), HasSubstr("10^{300}"));
    EXPECT_THAT(axis(0.37, 0.37 + 1e-6).common(), HasSubstr("+0.37"));
}

TEST(FigureAxis, LogarithmicShowsDecadesAndRefusesWhatHasNoLogarithm) {
    EXPECT_THAT(labels(axis(1e-3, 1e3, {.scale = Scale::logarithmic})), ::testing::Contains("10⁰"));
    EXPECT_TRUE(std::isnan(axis(1, 10, {.scale = Scale::logarithmic}).place(-1)));
    Extent none;
    none.add(std::vector{-1.0, 0.0, std::nan("")}, Scale::logarithmic);
    EXPECT_THROW(AxisMap({.scale = Scale::logarithmic}, none, 5, "test"), PictureError);
    EXPECT_THROW(AxisMap({.from = 2, .to = 2}, {}, 5, "test"), PictureError);
    EXPECT_THROW(AxisMap({.from = std::nan("")}, {}, 5, "test"), PictureError);
}

TEST(FigureAxis, LogarithmicHasPlainNumbersWithinADecade) {
    EXPECT_THAT(labels(axis(0.33, 0.79, {.scale = Scale::logarithmic})), ::testing::IsSupersetOf({"0.4", "0.7"}));
    EXPECT_THAT(labels(axis(0.4, 4, {.scale = Scale::logarithmic})), ::testing::IsSupersetOf({"0.5", "1", "2"}));
    EXPECT_THAT(labels(axis(0.08, 5, {.scale = Scale::logarithmic})),
                ::testing::ElementsAre("0.1", "1", "0.2", "0.5", "2", "5"));
    const AxisMap small({.scale = Scale::logarithmic}, {.any = true, .low = 1e-12, .high = 6e-11}, 3, "test");
    EXPECT_THAT(labels(small), ::testing::SizeIs(4));
}

TEST(FigureAxis, HasThreeNumbersWhereFourHaveRoom) {
    const auto numbers = [](int most) { return labels(AxisMap({.tight = true}, {true, 18.1, 39.7}, most, "test")); };
    EXPECT_THAT(numbers(4), ::testing::ElementsAre("20", "25", "30", "35"));
    EXPECT_THAT(numbers(3), ::testing::ElementsAre("20", "30"));
}

TEST(FigureAxis, UnitsGetThePrefixThatSuitsTheNumbers) {
    const AxisMap small = axis(0, -3e-6, {.label = "$w$ / mm"});
    EXPECT_EQ(small.label(), "$w$ / nm");
    EXPECT_EQ(small.common(), "");
    EXPECT_NEAR(small.tick_value(-3e-6), -3, 1e-12);
    EXPECT_THAT(labels(small), ::testing::Contains("−2"));
    EXPECT_NEAR(small.place(-1e-6), axis(0, -3e-6, {.label = "$w$"}).place(-1e-6), 1e-12);
    EXPECT_EQ(axis(0, 2e7, {.label = "$F$ / N"}).label(), "$F$ / MN");
    EXPECT_EQ(axis(0, 2e5, {.label = "$f$ / Hz"}).label(), "$f$ / kHz");
    const AxisMap slope = axis(0, -6e-3, {.label = "d$w$/d$x$ / 10^{−3}"});
    EXPECT_EQ(slope.label(), "d$w$/d$x$ / 10^{−6}");
    EXPECT_NEAR(slope.tick_value(-6e-3), -6, 1e-12);
    // Ordinary numbers and units without prefixes are not changed; nor are numbers with a common offset.
    EXPECT_EQ(axis(0, 300, {.label = "$F$ / N"}).label(), "$F$ / N");
    EXPECT_EQ(axis(0, 1e-6, {.label = "$θ$ / rad"}).label(), "$θ$ / rad");
    EXPECT_EQ(axis(0, 1e-6, {.label = "$θ$ / rad"}).common(), "×10^{−6}");
    EXPECT_EQ(axis(0.37, 0.37 + 1e-6, {.label = "$x$ / m"}).label(), "$x$ / m");
    EXPECT_THAT(axis(0.37, 0.37 + 1e-6, {.label = "$x$ / m"}).common(), HasSubstr("×10^{−6} +0.37"));
}

TEST(FigureAxis, OfAChartHasRoundEndsAndShortNumbers) {
    const auto chart = [](double low, double high, const char* label) {
        return AxisMap({.label = label, .tight = true, .round_ends = true, .short_numbers = true}, {true, low, high}, 5,
                       "test");
    };
    const AxisMap angle = chart(0.23, 0.84, "θ / rad");
    EXPECT_NEAR(angle.ends().low, 0.2, 1e-12);
    EXPECT_NEAR(angle.ends().high, 1.0, 1e-12);
    EXPECT_NEAR(angle.step(), 0.2, 1e-12);
    EXPECT_THAT(labels(angle), ::testing::ElementsAre("0.2", "0.4", "0.6", "0.8", "1.0"));
    EXPECT_EQ(angle.name(), "θ / rad");
    EXPECT_EQ(chart(0, 0.05, "F / N").name(), "F / mN");
    EXPECT_THAT(labels(chart(0, 0.05, "F / N")), ::testing::Contains("40"));
    EXPECT_EQ(chart(0, 1e-6, "θ / rad").name(), "θ / (10^{−6}\u2009rad)");
    EXPECT_EQ(chart(0, 5, "dθ/dt / rad/s").name(), "dθ/dt / (rad/s)");
    EXPECT_EQ(chart(0.785, 0.785 + 1e-6, "θ / rad").name(), "(θ − 0.785\u2009rad) / (10^{−9}\u2009rad)");
    EXPECT_EQ(chart(0, 2e-5, "n").name(), "n / 10^{−6}");
}

TEST(FigureAxis, CountsHaveTicksAtWholeNumbersOnly) {
    EXPECT_THAT(labels(axis(1, 3, {.counts = true})), ::testing::ElementsAre("1", "2", "3"));
    for (const auto& [low, high] : {std::pair{1.0, 2.0}, {1.0, 8.0}, {1.0, 20.0}, {1.0, 200.0}}) {
        const AxisMap a = axis(low, high, {.counts = true});
        for (const Tick& t : a.ticks()) {
            const double value = a.ends().low + t.at * (a.ends().high - a.ends().low);
            EXPECT_NEAR(value, std::round(value), 1e-9) << low << " " << high;
        }
    }
}

}  // namespace
}  // namespace beamcam::render
