#include "sim/cam/motion_law.hpp"

#include "tests/sim/cam/profiles.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

struct Peaks {
    MotionLaw law;
    double velocity, acceleration, jerk, accuracy;
};
constexpr double kPi = std::numbers::pi;
// VDI 2143 and Norton state these; those of polynomials are at the zeros of the next derivative.
const Peaks kPeaks[] = {
    {MotionLaw::cycloidal, 2, 2 * kPi, 4 * kPi* kPi, 1e-12},
    {MotionLaw::harmonic, kPi / 2, kPi* kPi / 2, kPi* kPi* kPi / 2, 1e-12},
    {MotionLaw::polynomial_345, 15.0 / 8, 10 / std::sqrt(3.0), 60, 1e-12},
    {MotionLaw::polynomial_4567, 35.0 / 16, 7.5131884, 52.5, 1e-7},
    {MotionLaw::modified_sine, 4 * kPi / (4 + kPi), 4 * kPi* kPi / (4 + kPi), 16 * kPi* kPi* kPi / (4 + kPi), 1e-12},
    {MotionLaw::modified_trapezoid, 2, 8 * kPi / (2 + kPi), 32 * kPi* kPi / (2 + kPi), 1e-12},
};

TEST(MotionLaw, PeaksOfTheDerivativesAreThePublishedOnes) {
    for (const Peaks& expected : kPeaks) {
        LawValue peak;
        for (int i = 0; i <= 40000; ++i) {
            const LawValue v = law_value(expected.law, i / 40000.0);
            peak.velocity = std::max(peak.velocity, std::fabs(v.velocity));
            peak.acceleration = std::max(peak.acceleration, std::fabs(v.acceleration));
            peak.jerk = std::max(peak.jerk, std::fabs(v.jerk));
        }
        // A step of 1/40000 next to a smooth peak misses 1e-8 of it.
        EXPECT_NEAR(peak.velocity, expected.velocity, 1e-7) << name(expected.law);
        EXPECT_NEAR(peak.acceleration, expected.acceleration, 1e-7 + expected.accuracy) << name(expected.law);
        EXPECT_NEAR(peak.jerk, expected.jerk, 1e-6) << name(expected.law);
    }
}

TEST(MotionLaw, DerivativesAreThoseOfS) {
    for (const auto& [law, name] : names(MotionLaw{})) {
        if (law == MotionLaw::dwell) continue;
        for (double u = 0.0137; u < 1; u += 0.0531) {
            const auto slope = [&, at = u](double LawValue::*part) {
                return scalar_slope_at_zero([&](double x) { return law_value(law, at + x).*part; }, 1e-3);
            };
            const LawValue v = law_value(law, u);
            EXPECT_NEAR(slope(&LawValue::s), v.velocity, 1e-11) << name << " " << u;
            EXPECT_NEAR(slope(&LawValue::velocity), v.acceleration, 1e-9) << name << " " << u;
            EXPECT_NEAR(slope(&LawValue::acceleration), v.jerk, 1e-8) << name << " " << u;
        }
    }
}

TEST(MotionLaw, EndsAreAtRestAndPiecesJoin) {
    for (const auto& [law, name] : names(MotionLaw{})) {
        if (law == MotionLaw::dwell) continue;
        EXPECT_NEAR(law_value(law, 0).s, 0, 1e-15) << name;
        EXPECT_NEAR(law_value(law, 1).s, 1, 1e-15) << name;
        EXPECT_NEAR(law_value(law, 0).velocity, 0, 1e-15) << name;
        EXPECT_NEAR(law_value(law, 1).velocity, 0, 1e-15) << name;
        for (const double u : law_breaks(law)) {
            const LawValue before = law_value(law, u), after = law_value(law, std::nextafter(u, 1));
            EXPECT_NEAR(before.s, after.s, 1e-15) << name << " " << u;
            EXPECT_NEAR(before.velocity, after.velocity, 1e-14) << name << " " << u;
            EXPECT_NEAR(before.acceleration, after.acceleration, 1e-13) << name << " " << u;
            EXPECT_NEAR(before.jerk, after.jerk, 1e-12) << name << " " << u;
        }
    }
}

TEST(MotionLaw, SegmentsFollowEachOtherOverTheTurn) {
    const ProgrammedMotion motion(lift_and_return());
    EXPECT_NEAR(motion.at(0).theta, 14 * kDegree, 1e-16);
    EXPECT_NEAR(motion.at(110 * kDegree).theta, 18 * kDegree, 1e-15);  // the middle of the rise
    EXPECT_NEAR(motion.at(110 * kDegree).velocity, 2 * 0.08, 1e-15);   // 2 h/b
    EXPECT_NEAR(motion.at(180 * kDegree).theta, 22 * kDegree, 1e-15);
    EXPECT_NEAR(motion.at(260 * kDegree).theta, 18 * kDegree, 1e-15);
    EXPECT_NEAR(motion.at(260 * kDegree).velocity, -15.0 / 8 * 8 / 120, 1e-15);
    EXPECT_NEAR(motion.at(350 * kDegree).theta, 14 * kDegree, 1e-16);
    EXPECT_NEAR(motion.at(-100 * kDegree).theta, motion.at(260 * kDegree).theta, 1e-15);
}

}  // namespace
}  // namespace beamcam::sim::testing
