// Events between two instants, for functions with zeros in closed form.
#include "sim/integrate/event_search.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

// A sum of two waves about a level, that turn by at most one radian and two in a unit of time.
struct Waves {
    double level, a, b, wa, wb, pa, pb;
    Guard operator()(double t) const {
        return {t, level + a * std::sin(wa * t + pa) + b * std::sin(wb * t + pb),
                a * wa * std::cos(wa * t + pa) + b * wb * std::cos(wb * t + pb)};
    }
};

constexpr int kFine = 4000;

// By brute force: the first of many samples in (0, 1] for which `below` holds.
template <class Below>
std::optional<double> first_sample(Below&& below) {
    for (int i = 1; i <= kFine; ++i)
        if (below(static_cast<double>(i) / kFine)) return static_cast<double>(i) / kFine;
    return std::nullopt;
}

Waves waves(Dice& dice) {
    return {0,
            dice.about_zero(1),
            dice.about_zero(0.5),
            dice.between(0.2, 1),
            dice.between(0.5, 2),
            dice.about_zero(3.2),
            dice.about_zero(3.2)};
}

// A level that the extremum of the function between 0 and 1, if it has one, misses or passes by a little.
template <class F>
double near_extremum(Dice& dice, double size, F&& f) {
    double low = f(0.0);
    for (int i = 0; i <= kFine; ++i) low = std::min(low, f(static_cast<double>(i) / kFine));
    return low + dice.about_zero(size);
}

TEST(FirstFall, FindsEveryDipHoweverShort) {
    Dice dice(1);
    int dips = 0, misses = 0;
    for (int repeat = 0; repeat < 1000; ++repeat) {
        Waves f = waves(dice);
        f.level = -near_extremum(dice, 1e-5, [&](double t) { return f(t).value; });
        if (!(f(0).value > 0)) continue;
        const auto seen = first_sample([&](double t) { return f(t).value < 0; });
        const auto found = first_fall(f, f(0), f(1));
        if (seen) {
            ++dips;
            ASSERT_TRUE(found) << repeat;
            EXPECT_NEAR(f(*found).value, 0, 1e-14) << repeat;
            EXPECT_LE(*found, *seen) << repeat;
        } else {
            ++misses;
            // Between two samples a dip is shallower than this.
            if (found) {
                EXPECT_GT(f(*found + 0.5 / kFine).value, -1e-7) << repeat;
            }
        }
    }
    EXPECT_GT(dips, 100);
    EXPECT_GT(misses, 100);
}

TEST(FirstFall, LeavesTheSurfaceItStartsOn) {
    const auto f = [](double t) { return Guard{t, t * (1 - 4 * t) * (1 - 4 * t), (1 - 4 * t) * (1 - 12 * t)}; };
    EXPECT_FALSE(first_fall(f, f(0), f(1), 1e-12));
    const auto g = [](double t) { return Guard{t, t * (0.5 - t), 0.5 - 2 * t}; };
    EXPECT_NEAR(*first_fall(g, g(0), g(1)), 0.5, 1e-15);
}

TEST(FirstFall, IgnoresDipsThatAreRounding) {
    const auto dip = [](double deep) {
        return [deep](double t) { return Guard{t, (t - 0.4) * (t - 0.4) - deep, 2 * (t - 0.4)}; };
    };
    EXPECT_FALSE(first_fall(dip(1e-9), dip(1e-9)(0), dip(1e-9)(1), 1e-8));
    EXPECT_TRUE(first_fall(dip(1e-7), dip(1e-7)(0), dip(1e-7)(1), 1e-8));
}

TEST(FirstFall, LooksCloserWhereRippleMayHide) {
    // Ten waves between the ends, which both lie on crests: only the bound of the ripple shows it.
    const double w = 20 * std::numbers::pi;
    const auto f = [&](double t) { return Guard{t, 0.5 + std::cos(w * t), -w * std::sin(w * t)}; };
    EXPECT_FALSE(first_fall(f, f(0), f(1)));
    const auto ripple = [&](double span) { return w * span > 2 ? Ripple{2, 2 * w} : Ripple{}; };
    EXPECT_NEAR(*first_fall(f, f(0), f(1), 0, ripple), std::acos(-0.5) / w, 1e-15);
}

TEST(FirstPassing, FindsEveryExcursionOfTheRate) {
    Dice dice(2);
    int passes = 0, misses = 0;
    for (int repeat = 0; repeat < 1000; ++repeat) {
        const Waves f = waves(dice);
        const double level = near_extremum(dice, 1e-4, [&](double t) { return f(t).rate; });
        const double small = 1e-5 * std::fabs(level) + 1e-9;  // an excursion that is no larger may be passed over
        if (!(f(0).rate > level)) continue;
        const auto seen = first_sample([&](double t) { return f(t).rate < level - small; });
        const auto found = first_passing(f, f(0), f(1), level, 1, 1e-9 * std::fabs(level), 0);
        if (seen) {
            ++passes;
            ASSERT_TRUE(found) << repeat;
            EXPECT_NEAR(f(*found).rate, level, 2e-9 * std::fabs(level) + 1e-14) << repeat;
            EXPECT_LE(*found, *seen) << repeat;
        } else {
            ++misses;
            if (found) {
                EXPECT_NEAR(f(*found).rate, level, small) << repeat;
            }
        }
    }
    EXPECT_GT(passes, 100);
    EXPECT_GT(misses, 100);
}

TEST(FirstPassing, BeginsWhereASearchThatStartsOnTheLevelHasLeftIt) {
    const auto f = [](double t) {
        return Guard{t, 0.5 * t * t - 0.5 * t * t * t, t - 1.5 * t * t};
    };  // ṫ = 0 at 0, 2/3
    EXPECT_NEAR(*first_passing(f, f(0), f(1), 0, 1, 1e-12, 0), 2.0 / 3, 1e-9);
    EXPECT_FALSE(first_passing(f, f(0), f(0.6), 0, 1, 1e-12, 0));
}

// Starts on the level, and so briefly before the end that rounding, here a fast wave, hides how the value curves.
TEST(FirstPassing, DoesNotSearchTheRoundingOfTheValue) {
    constexpr double level = -0.2, span = 1e-11, none = 2e-10;
    Dice dice(3);
    int probes = 0, unlimited = 0;
    for (int repeat = 0; repeat < 100; ++repeat) {
        const double start = dice.between(1e-5, 1e-3), acceleration = dice.about_zero(1e6);
        const auto f = [&](double t) {
            ++probes;
            return Guard{t, start + level * t + 1e-15 * std::sin(1e15 * t), level + acceleration * t};
        };
        const auto found = first_passing(f, f(0), f(span), level, 1, none, 1e-14);
        ASSERT_EQ(found.has_value(), acceleration < 0) << repeat;
        EXPECT_EQ(found.value_or(span), span) << repeat;
        const int before = probes;
        first_passing(f, f(0), f(span), level, 1, none, 0);
        unlimited += probes - before;
        probes = before;
    }
    EXPECT_EQ(probes, 200);  // the ends
    EXPECT_GT(unlimited, 10000);
}

}  // namespace
}  // namespace beamcam::sim::testing
