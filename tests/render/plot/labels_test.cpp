#include "render/plot/labels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "render/draw/markup.hpp"

namespace beamcam::render {
namespace {

TEST(Labels, SpeedsAreToldAsFractions) {
    EXPECT_EQ(speed_text(1, true), "");
    EXPECT_EQ(speed_text(0.02, true), "1/50 speed");
    EXPECT_EQ(speed_text(0.004 * (1 + 1e-9), true), "1/250 speed");  // rounding is no other speed
    EXPECT_EQ(speed_text(0.5, true), "1/2 speed");
    EXPECT_EQ(speed_text(0.037, false), "1/20 speed");  // on the way from one speed to another
    EXPECT_EQ(speed_text(0.97, false), "");
    EXPECT_TRUE(steady_speed({0.037, 0, 0.037}));
    EXPECT_FALSE(steady_speed({0.037, 0.04}));
    EXPECT_EQ(speed_text(0.037, true), "0.037× speed");
    EXPECT_EQ(speed_text(0.97, true), "0.97× speed");
    EXPECT_EQ(speed_text(0, true), "frozen");
    EXPECT_EQ(speed_text(4, true), "4× speed");
    EXPECT_EQ(speed_text(600, true), "600× speed");  // no exponents
    EXPECT_EQ(speed_text(6.73e-5, true), "1/14900 speed");
    EXPECT_EQ(speed_text(1.53, true), "1.5× speed");
}

TEST(Labels, UnusualParametersAreStated) {
    const auto has = [](const sim::Problem& problem, const char* text) {
        return std::ranges::any_of(parameter_pieces(problem),
                                   [&](const std::string& piece) { return to_plain(piece) == text; });
    };
    sim::Problem problem;
    const std::size_t usual = parameter_pieces(problem).size();
    problem.beam.damping_ratio = {0};
    EXPECT_EQ(parameter_pieces(problem).size(), usual);
    problem.gravity = 1.62;
    problem.hub.radius = 0.06, problem.hub.inertia = 0.05;
    problem.beam.damping_ratio = {0.01, 0.02};
    EXPECT_EQ(parameter_pieces(problem).size(), usual + 4);
    EXPECT_TRUE(has(problem, "g\u2009=\u20091.62\u00A0m/s²"));
    EXPECT_TRUE(has(problem, "a\u2009=\u200960\u00A0mm"));
    EXPECT_TRUE(has(problem, "I_h\u2009=\u20090.05\u00A0kg\u2009m²"));
    EXPECT_TRUE(has(problem, "ζ\u2009=\u20090.01 … 0.02"));
    problem.beam.damping_ratio.clear(), problem.beam.kelvin_voigt = 5e-4;
    EXPECT_TRUE(has(problem, "η\u2009=\u2009500\u00A0µs"));
}

TEST(Labels, ComparedMotionsStateWhatDiffers) {
    sim::Problem flexible, rigid, fast;
    rigid.beam.model = sim::ModelKind::rigid;
    fast.beam.modes = 8, fast.cam->speed = 5;
    const auto own = [](std::vector<const sim::Problem*> problems, const std::vector<std::string>& labels) {
        std::vector<std::string> out;
        for (const std::string& piece : compared_pieces(problems, labels, {}, {}))
            if (to_plain(piece).find(": ") != std::string::npos) out.push_back(to_plain(piece));
        return out;
    };
    EXPECT_EQ(own({&flexible, &rigid}, {"flexible", "rigid"}),
              std::vector<std::string>{"flexible: first-order, 2 modes"});
    EXPECT_EQ(own({&flexible, &fast}, {"ω = 1 rad/s", "ω = 5 rad/s"}),
              (std::vector<std::string>{"ω = 1 rad/s: 2 modes", "ω = 5 rad/s: 8 modes"}));
}

TEST(Labels, BothCoefficientsOfStickSlipAreTold) {
    sim::Problem problem;
    problem.contact.friction = sim::StickSlipFriction{0.2, 0.35, {}};
    const std::vector<std::string> pieces = parameter_pieces(problem);
    const auto found =
        std::ranges::find_if(pieces, [](const std::string& piece) { return piece.find("0.2") != std::string::npos; });
    ASSERT_NE(found, pieces.end());
    EXPECT_NE(found->find("0.35"), std::string::npos) << *found;
}

TEST(Labels, ClockShowsADifferenceBetweenNeighbouringFrames) {
    const TimeFormat f = time_format({0, 1 / 60.0, 2 / 60.0, 10});
    EXPECT_EQ(f.decimals, 2);
    EXPECT_NE(clock_text(f, 1 / 60.0), clock_text(f, 2 / 60.0));
    EXPECT_EQ(time_format({0, 1 / 30.0, 2 / 30.0, 20}).decimals, 1);  // of a long film at 30 frames a second
    const TimeFormat slow = time_format({0.01, 0.01001, 0.0102});
    EXPECT_STREQ(slow.symbol, "ms");
    EXPECT_NE(clock_text(slow, 0.01), clock_text(slow, 0.01001));
}

// A film of one frame states its instant in the unit of its charts.
TEST(Labels, TheUnitOfTimeSuitsTheCharts) {
    EXPECT_STREQ(time_format({0}, 0.02).symbol, "ms");
    EXPECT_STREQ(time_format({0}, 2).symbol, "s");
    EXPECT_STREQ(time_format({0.01}, 0.05).symbol, "ms");
}

TEST(Labels, AStillShowsTheDigitsOfARoundInstantAndFourOfAnEvents) {
    EXPECT_EQ(time_format({0.28}, 1).decimals, 2);
    EXPECT_EQ(time_format({0.2815}, 1).decimals, 4);
    EXPECT_EQ(time_format({0.281525}, 1).decimals, 6);
    EXPECT_EQ(time_format({0.28152518347}, 1).decimals, 4);
}

// Freezes at round times cause steps of rounding size, and one irregular step each.
TEST(Labels, FreezesDoNotCountForTheDecimalsOfTheClock) {
    std::vector<double> times;
    for (int k = 0; k < 30; ++k) {
        times.push_back(k / 30.0);
        if (k % 10 == 3) times.insert(times.end(), 15, k / 30.0 + 1e-16 + (k == 13 ? 1e-7 : 0));
    }
    EXPECT_EQ(time_format(times).decimals, 1);
}

// Only what lasts less than 0.2 s is in milliseconds, with four digits.
TEST(Labels, TheClockHasNoMoreDecimalsThanItNeeds) {
    const auto decimals = [](double step) { return time_format({0.2, 0.2 + step, 0.2 + 2 * step}).decimals; };
    EXPECT_EQ(decimals(0.1), 1);
    EXPECT_EQ(decimals(1 / 60.0), 2);
    EXPECT_EQ(decimals(0.0033), 2);
    EXPECT_EQ(decimals(0.0001), 4);
    EXPECT_STREQ(time_format({0.2, 0.2005, 0.201}).symbol, "s");
    EXPECT_STREQ(time_format({0.2, 0.2005, 1.2}).symbol, "s");
    EXPECT_STREQ(time_format({0.28152518347}, 0.5).symbol, "s");
    EXPECT_EQ(time_format({0.12684631234}).decimals, 1);
}

TEST(Labels, SpeedsOfRotationAreWrittenAsTheUserWroteThem) {
    EXPECT_EQ(turning_speed(0.5, SpeedUnit::automatic), "0.5\u00A0rad/s");
    EXPECT_EQ(turning_speed(-10 * std::numbers::pi, SpeedUnit::rpm), "−300\u00A0rpm");
    EXPECT_EQ(turning_speed(-std::numbers::pi / 6, SpeedUnit::degrees), "−30°/s");
    EXPECT_EQ(turning_speed(0, SpeedUnit::automatic), "0\u00A0rad/s");
}

TEST(Labels, LargeNumbersArePowersOfTen) {
    EXPECT_EQ(power_text(1e8), "10^{8}");
    EXPECT_EQ(power_text(2.5e7), "2.5·10^{7}");
    EXPECT_EQ(power_text(200), "200");
    EXPECT_EQ(power_text(3e-10), "3·10^{−10}");
}

}  // namespace
}  // namespace beamcam::render
