// Classes of artificial motions that meet and miss every criterion.
#include "sim/sweep/attractor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace beamcam::sim {
namespace {

SampledMotion strobed(int turns, const std::function<Strobe(int)>& at) {
    SampledMotion motion;
    for (int k = 0; k < turns; ++k) motion.strobes.push_back(at(k));
    return motion;
}

AttractorClass kind(const SampledMotion& motion) { return classify(Problem{}, motion).kind; }

// A circle of states, once around in `turns` turns of the cam.
SampledMotion circle(double turns) {
    return strobed(60, [=](int k) {
        return Strobe{0.4 + 0.1 * std::sin(6.2831853 * k / turns), std::cos(6.2831853 * k / turns), 2L * k, false,
                      true};
    });
}

TEST(Attractor, HasAPeriodWhenStatesReturn) {
    const Attractor a = classify(Problem{}, circle(5));
    EXPECT_EQ(a.kind, AttractorClass::periodic);
    EXPECT_EQ(a.period, 5);
    EXPECT_EQ(a.impacts_per_period, 10);
}

TEST(Attractor, IsAperiodicWithoutAPeriod) { EXPECT_EQ(kind(circle(5.3137)), AttractorClass::aperiodic); }

TEST(Attractor, IsUnsettledWhenAPeriodBeginsWithinTheSamples) {
    SampledMotion motion = circle(5.3137);
    for (std::size_t k = 30; k < motion.strobes.size(); ++k) motion.strobes[k] = motion.strobes[30];
    EXPECT_EQ(kind(motion), AttractorClass::unsettled);
}

TEST(Attractor, IsUnsettledWhileItStillDrawsNearAPeriod) {
    const auto spiral = [](double rate) {
        return strobed(60, [=](int k) {
            return Strobe{0.4 + 1e-3 * std::exp(-rate * k) * (k % 2 ? 1 : -1), 0, k, false, true};
        });
    };
    EXPECT_EQ(kind(spiral(0.05)), AttractorClass::unsettled);
    EXPECT_EQ(kind(spiral(0)), AttractorClass::periodic);
}

TEST(Attractor, IsUnsettledWhileAShorterPeriodDrawsTogetherTooSlowlyToBeSeen) {
    // States two turns apart agree within 10⁻⁵ while those one turn apart still fall, exponentially or as 1/√k: period
    // one.
    const auto alternating = [](const std::function<double(int)>& size) {
        return strobed(60, [=](int k) { return Strobe{0.4 + 1e-7 * size(k) * (k % 2 ? 1 : -1), 0, k, false, true}; });
    };
    const double scale = 100;  // of the lift's 10⁻⁵
    EXPECT_EQ(kind(alternating([=](int k) { return scale * std::exp(-1e-4 * k); })), AttractorClass::unsettled);
    EXPECT_EQ(kind(alternating([=](int k) { return scale / std::sqrt(1 + k / 5000.0); })), AttractorClass::unsettled);
    EXPECT_EQ(kind(alternating([=](int k) { return scale * std::exp(1e-4 * k); })), AttractorClass::unsettled);
    EXPECT_EQ(kind(alternating([=](int k) { return scale * (1 + 1e-3 * std::exp(-0.3 * k)); })),
              AttractorClass::periodic);
}

TEST(Attractor, FollowsWhereTheContactLasts) {
    const auto contact = [](bool left, double theta_dot) {
        return strobed(60, [=](int k) { return Strobe{0.4, theta_dot, 0, true, left && k == 40}; });
    };
    EXPECT_EQ(kind(contact(false, 0.3)), AttractorClass::following);
    EXPECT_EQ(kind(contact(true, 0.3)), AttractorClass::periodic);
    Problem still;
    still.cam->speed = 0;
    EXPECT_EQ(classify(still, contact(false, 0)).kind, AttractorClass::rest);
}

TEST(Attractor, IsUnsettledInFewTurns) {
    SampledMotion motion = circle(5.3137);
    motion.strobes.resize(11);
    EXPECT_EQ(kind(motion), AttractorClass::unsettled);
}

TEST(Attractor, SaysThatAFailedMotionIsUnsettled) {
    SampledMotion motion = circle(5);
    motion.failure = "too slow";
    EXPECT_EQ(kind(motion), AttractorClass::unsettled);
}

TEST(Attractor, NamesItsClassesInTheirOrder) {
    for (const auto& each : names(AttractorClass{})) EXPECT_STREQ(name(each.value), each.name);
}

}  // namespace
}  // namespace beamcam::sim
