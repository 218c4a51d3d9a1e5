#include "scenes/format/units.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "sim/observe/channels.hpp"

namespace beamcam::scenes {
namespace {

double value(std::string_view text, const Dimension& expected) {
    const QuantityText read = parse_quantity(text);
    EXPECT_TRUE(read.quantity) << text << ": " << read.problem;
    if (!read.quantity) return 0;
    EXPECT_TRUE(same(read.quantity->dimension, expected))
        << text << " has dimension " << si_unit(read.quantity->dimension);
    return read.quantity->value;
}

TEST(Units, DecimalPrefixesGiveTheVeryNumberThatSiWouldBe) {
    // No rounding of their own: the decimal point is moved in the text.
    EXPECT_EQ(value("36.8 mm", dimension::kLength), 0.0368);
    EXPECT_EQ(value("72.968 mm^2", dimension::kArea), 7.2968e-5);
    EXPECT_EQ(value("8218.9 mm^4", dimension::kSecondMoment), 8.2189e-9);
    EXPECT_EQ(value("68.952 GPa", dimension::kPressure), 6.8952e10);
    EXPECT_EQ(value("2.7667 g/cm^3", dimension::kDensity), 2766.7);
    EXPECT_EQ(value("20 ms", dimension::kTime), 0.02);
    EXPECT_EQ(value("1.5e3 um", dimension::kLength), 1.5e-3);
    EXPECT_EQ(value("1 kg", Dimension{0, 1, 0, 0}), 1);
}

TEST(Units, AnglesAndTurnsAreExactToTheLastBit) {
    EXPECT_EQ(value("45 deg", dimension::kAngle), 45 * (std::numbers::pi / 180));
    EXPECT_EQ(value("45 deg", dimension::kAngle), 0.78539816339744830962);  // the default of initial.angle
    EXPECT_EQ(value("180°", dimension::kAngle), std::numbers::pi);
    EXPECT_EQ(value("60 rpm", dimension::kAngularSpeed), 60 * (2 * std::numbers::pi / 60));
    EXPECT_EQ(value("2 rev", dimension::kAngle), 4 * std::numbers::pi);
    EXPECT_EQ(value("-5 rad/s", dimension::kAngularSpeed), -5);
}

TEST(Units, ProductsQuotientsAndExponentsMeanWhatTheySay) {
    EXPECT_EQ(value("9.81 m/s^2", dimension::kAcceleration), 9.81);
    EXPECT_EQ(value("9.81 m/s/s", dimension::kAcceleration), 9.81);
    EXPECT_EQ(value("9.81 m s^-2", dimension::kAcceleration), 9.81);
    EXPECT_EQ(value("9.81 m·s⁻²", dimension::kAcceleration), 9.81);
    EXPECT_EQ(value("9.81 m s-2", dimension::kAcceleration), 9.81);
    EXPECT_EQ(value("3 kg m²", dimension::kInertia), 3);
    EXPECT_EQ(value("3 kg*m2", dimension::kInertia), 3);
    EXPECT_EQ(value("2 N/m/s", Dimension{0, 1, -3, 0}), 2);
    EXPECT_EQ(value("1e8 N/m^1.5", dimension::contact_stiffness(1.5)), 1e8);
    EXPECT_EQ(value("5 1/s", dimension::kFrequency), 5);
    EXPECT_EQ(value("5 %", dimension::kNone), 0.05);
    EXPECT_EQ(value("+.5e1 s", dimension::kTime), 5);
}

TEST(Units, FractionalPowersOfAPrefixScaleByTheRoot) {
    // 1 N/mm^1.5 = 10^4.5 N/m^1.5; pow and the decimal shift may differ by a rounding each.
    EXPECT_NEAR(value("1 N/mm^1.5", dimension::contact_stiffness(1.5)) / 31622.776601683792, 1, 4e-16);
}

TEST(Units, CyclesAreNotRadians) {
    EXPECT_FALSE(same(parse_quantity("5 Hz").quantity->dimension, dimension::kAngularSpeed));
    EXPECT_FALSE(same(parse_quantity("5 1/s").quantity->dimension, dimension::kAngularSpeed));
}

TEST(Units, WhatIsNoQuantityIsReported) {
    for (const char* text : {"",      "mm",    "twelve mm", "12 parsec", "12 mm^",  "12 mm^x",   "12 m//s",
                             "12 (m", "12 m)", "12 kg/m s", "12 m^99",   "1e999 m", "1e300 GN",  "inf m",
                             "nan",   "12 m/", "+-3 m",     "12 mm mm)", "0x10 m",  "12 N/(m s)"}) {
        const QuantityText read = parse_quantity(text);
        const bool finite = read.quantity.has_value();
        EXPECT_FALSE(finite && std::string(text) != "1e300 GN") << text;
        if (!finite) {
            EXPECT_FALSE(read.problem.empty()) << text;
        }
    }
    EXPECT_NE(parse_quantity("3 Mpa").problem.find("did you mean \"MPa\""), std::string::npos);
    const auto suggested = [](const char* text, const Dimension& dimension) {
        return parse_quantity(text, &dimension).problem;
    };
    EXPECT_EQ(suggested("3 Nm", dimension::kTorque), "unknown unit \"Nm\"; did you mean \"N m\"?");
    EXPECT_EQ(suggested("1 gn", dimension::kAcceleration), "unknown unit \"gn\"");
    EXPECT_EQ(suggested("1000 MM", dimension::kLength), "unknown unit \"MM\"; did you mean \"mm\"?");
    EXPECT_EQ(suggested("10 grad", dimension::kAngle), "unknown unit \"grad\"; write deg");
    EXPECT_EQ(suggested("10 Grad", dimension::kAngle), "unknown unit \"Grad\"; write deg");
    EXPECT_NE(parse_quantity("1e307 GN").problem.find("out of the range"), std::string::npos);
}

TEST(Units, ExponentsAreReadWholeOrRejected) {
    EXPECT_EQ(parse_quantity("2 m⁻¹²").quantity.value().dimension.length, -12);
    EXPECT_EQ(parse_quantity("2 m12").quantity.value().dimension.length, 12);
    for (const char* text : {"6 m014", "6 m^13", "6 m^nan", "6 m^inf", "6 m¹³", "6 m¹²³⁴", "6 s⁻", "6 m^"}) {
        const QuantityText read = parse_quantity(text);
        EXPECT_FALSE(read.quantity) << text;
        EXPECT_FALSE(read.problem.empty()) << text;
    }
    EXPECT_NE(parse_quantity("6 m014").problem.find("beyond ±12"), std::string::npos);
    // An exponent at the end of the integers, moved by the prefix.
    EXPECT_EQ(parse_quantity("0e2147483647 GN").quantity.value_or(Quantity{}).value, 0);
}

TEST(Units, ThoseOfAllChannelsAreRead) {
    for (const sim::ChannelRow& channel : sim::kChannels)
        EXPECT_TRUE(parse_quantity(fmt::format("1 {}", channel.unit)).quantity)
            << channel.name << ": kUnits in scenes/format/units.cpp has no " << channel.unit;
}

TEST(Units, EveryDimensionOfTheFormatNamesAUnitThatReadsBack) {
    for (const Dimension& d :
         {dimension::kLength, dimension::kArea, dimension::kSecondMoment, dimension::kTime, dimension::kFrequency,
          dimension::kAngle, dimension::kAngularSpeed, dimension::kSpeed, dimension::kAcceleration, dimension::kDensity,
          dimension::kPressure, dimension::kInertia, dimension::kTorque, dimension::kSpringStiffness,
          dimension::contact_stiffness(1.5), dimension::contact_stiffness(1), dimension::contact_stiffness(2)})
        EXPECT_EQ(value("2 " + si_unit(d), d), 2) << si_unit(d);
}

}  // namespace
}  // namespace beamcam::scenes
