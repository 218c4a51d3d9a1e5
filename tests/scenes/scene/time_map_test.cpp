#include "scenes/scene/time_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render/base/error.hpp"
#include "scenes/scene/film_times.hpp"
#include "tests/sanitizers.hpp"

namespace beamcam::scenes {
namespace {

sim::Impact impact(double from, double to) {
    sim::Impact one;
    one.t_start = from, one.t_end = to;
    return one;
}
const std::vector<sim::Impact> kImpacts{impact(0.300, 0.301), impact(0.304, 0.305), impact(0.800, 0.802)};
const Speed kSlow{.factor = 1, .around = SlowMotion{.factor = 0.02, .before = 2e-3, .after = 10e-3, .ease = 20e-3}};

TEST(Instants, AnUnfinishedRiseHasNoApex) {
    sim::Result motion;
    motion.collisions.resize(2);
    motion.collisions[0].t_start = 0.2, motion.collisions[1].t_start = 0.5;
    motion.apexes = {{0.3, 0.7}, {0.4, 0.8}, {0.6, 1.0}};
    motion.end_time = 0.9, motion.end_theta = 0.9;
    const Instant second{.kind = Instant::Kind::apex, .number = 2};
    EXPECT_EQ(find_instant({.kind = Instant::Kind::apex, .number = 1}, motion), 0.4);
    EXPECT_EQ(find_instant(second, motion), 0.6);
    motion.end_theta = 1.1;
    EXPECT_FALSE(find_instant(second, motion));
}

TEST(Instants, OfCollisionsThatHaveNoneSayWhy) {
    sim::Result motion;
    motion.collisions.resize(2);
    motion.collisions[1].t_peak = 0.5, motion.collisions[1].t_bend = 0.6;
    const auto told = [&](Instant::Kind kind, int number) -> std::string {
        try {
            return std::to_string(instant_of({.kind = kind, .number = number}, motion));
        } catch (const render::PictureError& error) {
            return error.what();
        }
    };
    EXPECT_EQ(told(Instant::Kind::peak, 2), "0.500000");
    EXPECT_EQ(told(Instant::Kind::bend, 2), "0.600000");
    EXPECT_THAT(told(Instant::Kind::peak, 1),
                ::testing::HasSubstr("a pure impulse, without a finite force; take \"collision:1\""));
    EXPECT_THAT(told(Instant::Kind::bend, 1),
                ::testing::HasSubstr("the beam does not bend; choose another beam.model"));
    EXPECT_THAT(told(Instant::Kind::collision, 3),
                ::testing::HasSubstr("collision 3 does not occur: the motion has 2 of them"));
}

TEST(TimeMap, AConstantSpeedIsALine) {
    const TimeMap map(0.5, 2, {.factor = 0.25, .around = {}}, {});
    EXPECT_DOUBLE_EQ(map.duration(), 6);
    for (double film : {0.0, 1.0, 3.7, 6.0}) EXPECT_DOUBLE_EQ(map.instant(film), 0.5 + 0.25 * film);
    EXPECT_EQ(map.speed(1), 0.25);
}

TEST(TimeMap, IsMonotoneAndEndsWhereItShould) {
    const TimeMap map(0, 1, kSlow, kImpacts);
    double before = -1;
    for (int k = 0; k <= 20000; ++k) {
        const double t = map.instant(map.duration() * k / 20000);
        EXPECT_GT(t, before);
        before = t;
    }
    EXPECT_EQ(map.instant(0), 0);
    EXPECT_NEAR(before, 1, 1e-12);
}

TEST(TimeMap, RunsAtTheFactorFromBeforeTheTouchUntilAfterTheRelease) {
    const TimeMap map(0, 1, kSlow, kImpacts);
    for (double t : {0.2981, 0.300, 0.302, 0.304, 0.3149, 0.800, 0.8119}) EXPECT_EQ(map.speed_at(t), 0.02) << t;
    for (double t : {0.0, 0.2, 0.2779, 0.3351, 0.6, 0.9}) EXPECT_EQ(map.speed_at(t), 1) << t;
    for (double t : {0.29, 0.32}) {
        EXPECT_GT(map.speed_at(t), 0.02);
        EXPECT_LT(map.speed_at(t), 1);
    }
}

TEST(TimeMap, ChosenCollisionsAloneAreSlow) {
    std::vector<sim::Impact> impacts = kImpacts;
    impacts[2].collision = 2;
    Speed speed = kSlow;
    speed.around->collisions = {2};
    const TimeMap map(0, 1, speed, impacts);
    EXPECT_EQ(map.speed_at(0.301), 1);
    EXPECT_EQ(map.speed_at(0.801), 0.02);
}

Instant at(double t) { return {.kind = Instant::Kind::time, .t = t}; }

// Without eases the film lasts as long as its pieces do; intervals that adjoin change speed at once.
TEST(TimeMap, IntervalsHaveTheirOwnSpeeds) {
    Speed speed{.factor = 2, .intervals = {{at(0.2), at(0.4), 0.1}, {at(0.4), at(0.5), 0.5}}, .ease = 0};
    const TimeMap map(0, 1, speed, {});
    EXPECT_NEAR(map.duration(), 0.2 / 2 + 0.2 / 0.1 + 0.1 / 0.5 + 0.5 / 2, 1e-12);
    EXPECT_EQ(map.speed_at(0.3), 0.1);
    EXPECT_EQ(map.speed_at(0.45), 0.5);
    EXPECT_EQ(map.speed_at(0.7), 2);
    speed.ease = 0.05;
    const TimeMap eased(0, 1, speed, {});
    EXPECT_EQ(eased.speed_at(0.14), 2);
    EXPECT_LT(eased.speed_at(0.19), 0.2);
    EXPECT_EQ(eased.speed_at(0.39), 0.1);
    for (int k = 1; k < 200; ++k) {
        const double film = eased.duration() * k / 200, h = 1e-6;
        if (std::abs(eased.instant(film) - 0.4) < 1e-4) continue;
        EXPECT_NEAR((eased.instant(film + h) - eased.instant(film - h)) / (2 * h) / eased.speed(film), 1, 1e-3) << film;
    }
}

TEST(FilmTimes, IntervalsThatOverlapAreRejected) {
    FrameSpan span;
    span.speed = {.factor = 1, .intervals = {{at(0.2), at(0.4), 0.1}, {at(0.3), at(0.5), 0.5}}};
    EXPECT_THROW(film_times(span, 1, {}, {}), render::PictureError);
    span.speed.intervals = {{at(0.4), at(0.2), 0.1}};
    EXPECT_THROW(film_times(span, 1, {}, {}), render::PictureError);
}

TEST(FilmTimes, TheCameraArrivesAtTheFrameOfItsInstant) {
    FilmTimes times;
    for (int k = 0; k < 60; ++k) times.frames.push_back(k / 30.0);
    View view;
    view.keyframes = {{.at = at(1), .zoom = 4.0, .over = 0.5}, {.at = at(5), .pitch = 0.1}};
    add_moves(times, view, 30, {}, false);
    ASSERT_EQ(times.moves.size(), 2U);
    EXPECT_EQ(times.moves[0].arrives, 30);
    EXPECT_EQ(times.moves[0].lasts, 15);
    EXPECT_EQ(times.moves[1].shot.zoom, 4);  // as it was
    EXPECT_NEAR(times.moves[1].arrives, 150, 1e-9);
    view.keyframes = {{.at = {.kind = Instant::Kind::impact, .number = 3}}};
    EXPECT_THROW(add_moves(times, view, 30, {}, false), render::PictureError);
    add_moves(times, view, 30, {}, true);
    EXPECT_EQ(times.unreached_events.back(), "the camera at impact 3");
}

// dτ = dt/s: the film's rate is the speed, by central differences of the instants.
TEST(TimeMap, SpeedIsTheRateOfTheInstants) {
    const TimeMap map(0, 1, kSlow, kImpacts);
    const double h = 1e-5;
    for (int k = 1; k < 400; ++k) {
        const double film = map.duration() * k / 400;
        const double rate = (map.instant(film + h) - map.instant(film - h)) / (2 * h);
        EXPECT_NEAR(rate / map.speed(film), 1, 1e-4) << film;
    }
}

TEST(TimeMap, SpeedChangesWithoutAJump) {
    const TimeMap map(0, 1, kSlow, kImpacts);
    double before = map.speed_at(0.25);
    for (double t = 0.25; t < 0.36; t += 1e-5) {
        // log s falls by ln 50 over the ease, at most 1.5 times as fast as on average: 0.3 % in each step.
        EXPECT_NEAR(map.speed_at(t) / before, 1, 3.1e-3) << t;
        before = map.speed_at(t);
    }
}

TEST(TimeMap, FilmTimeIsTheInverse) {
    TimeMap map(0, 1, kSlow, kImpacts);
    map.freeze(0.3, 2);
    for (double t : {0.0, 0.1, 0.29, 0.2999, 0.301, 0.33, 0.7, 0.805, 0.95})
        EXPECT_NEAR(map.instant(map.film_time(t)), t, 1e-12) << t;
}

TEST(TimeMap, AFreezeHoldsOneInstant) {
    TimeMap map(0, 1, {}, {});
    map.freeze(0.4, 1.5);
    EXPECT_DOUBLE_EQ(map.duration(), 2.5);
    for (double film : {0.41, 1.0, 1.89}) {
        EXPECT_EQ(map.instant(film), 0.4);
        EXPECT_EQ(map.speed(film), 0);
    }
    EXPECT_NEAR(map.instant(2.0), 0.5, 1e-12);
    EXPECT_EQ(map.speed(2.0), 1);
    EXPECT_NEAR(map.instant(0.2), 0.2, 1e-12);
}

TEST(TimeMap, OverlappingSpansAreOne) {
    const TimeMap both(0, 1, kSlow, kImpacts), one(0, 1, kSlow, {impact(0.300, 0.305), impact(0.800, 0.802)});
    EXPECT_DOUBLE_EQ(both.duration(), one.duration());
}

TEST(TimeMap, ANumberBeyondTheImpactsIsRejectedWithTheirCount) {
    sim::Result motion;
    motion.impacts = kImpacts;
    EXPECT_EQ(instant_of({.kind = Instant::Kind::impact, .number = 3}, motion), 0.8);
    try {
        instant_of({.kind = Instant::Kind::impact, .number = 4}, motion);
        FAIL();
    } catch (const render::PictureError& error) {
        EXPECT_NE(std::string(error.what()).find("has 3"), std::string::npos) << error.what();
    }
}

TEST(FilmTimes, RealTimeIsTheFramesGrid) {
    const FilmTimes times = film_times({.fps = {10, 1}, .from = 0.2, .to = 0.5}, 1, {}, {});
    EXPECT_EQ(times.frames, (std::vector{2 / 10.0, 3 / 10.0, 4 / 10.0}));
    EXPECT_EQ(times.first, 2);
    EXPECT_TRUE(times.speeds.empty());
}

TEST(FilmTimes, PartsThatAdjoinHaveEachFrameOnce) {
    const auto frames = [](double from, double to) {
        return film_times({.fps = {25, 1}, .from = from, .to = to}, 1, {}, {}).frames;
    };
    for (const double cut : {0.24, 0.25, 0.27, 0.28}) {
        std::vector<double> parts = frames(0, cut);
        const std::vector<double> second = frames(cut, 0.4);
        parts.insert(parts.end(), second.begin(), second.end());
        EXPECT_EQ(parts, frames(0, 0.4)) << cut;
    }
    EXPECT_EQ(frames(0.25, 0.32), (std::vector{6 / 25.0, 7 / 25.0}));
}

TEST(FilmTimes, SlowMotionHasRowsBetweenItsFrames) {
    sim::Result motion;
    motion.impacts = kImpacts;
    const FilmTimes times = film_times({.fps = {60, 1}, .speed = kSlow}, 1, motion, motion.impacts);
    EXPECT_EQ(times.frames.size(), times.speeds.size());
    EXPECT_TRUE(std::is_sorted(times.frames.begin(), times.frames.end()));
    EXPECT_TRUE(std::is_sorted(times.chart.begin(), times.chart.end()));
    const auto within = [](const std::vector<double>& all, double from, double to) {
        return std::lower_bound(all.begin(), all.end(), to) - std::lower_bound(all.begin(), all.end(), from);
    };
    // 1 ms at a fiftieth is 3 frames, of eight rows each.
    EXPECT_NEAR(double(within(times.frames, 0.300, 0.301)), 3, 1);
    EXPECT_GE(within(times.chart, 0.300, 0.301), 22);
}

TEST(FilmTimes, AStillOfAnImpactHasChartsToTheEndOfItsCollision) {
    sim::Result motion;
    const auto add = [&](double from, double to, int collision) {
        sim::Impact& next = motion.impacts.emplace_back();
        next.t_start = from, next.t_end = to, next.collision = collision;
    };
    add(0.300, 0.301, 1), add(0.305, 0.306, 1), add(0.600, 0.601, 2);
    const FilmTimes of_impact = still_times({.kind = Instant::Kind::impact, .number = 1}, motion, 1);
    EXPECT_EQ(of_impact.frames, std::vector{0.3});
    EXPECT_GE(of_impact.chart.back(), 0.306);
    EXPECT_LT(of_impact.chart.back(), 0.31);
    EXPECT_TRUE(std::ranges::is_sorted(of_impact.chart));
    // Not beyond the motion; and a still of an instant shows its past alone.
    EXPECT_EQ(still_times({.kind = Instant::Kind::impact, .number = 1}, motion, 0.303).chart.back(), 0.303);
    EXPECT_EQ(still_times({.kind = Instant::Kind::time, .t = 0.3}, motion, 1).chart.back(), 0.3);
}

TEST(FilmTimes, StillsHaveRowsWithinTheCollisionsOfAStrip) {
    sim::Result motion;
    for (int i = 0; i < 3; ++i) {
        sim::Impact& next = motion.impacts.emplace_back();
        next.t_start = 0.2 + 0.2 * i, next.t_end = 0.21 + 0.2 * i, next.collision = i + 1;
    }
    const Instant at{.kind = Instant::Kind::time, .t = 0.7};
    const auto within = [&](const std::vector<double>& all, const sim::Impact& i) {
        return std::lower_bound(all.begin(), all.end(), *i.t_end) - std::lower_bound(all.begin(), all.end(), i.t_start);
    };
    const FilmTimes plain = still_times(at, motion, 1), fine = still_times(at, motion, 1, motion.impacts);
    for (const sim::Impact& i : motion.impacts) EXPECT_GT(within(fine.chart, i), 300);
    EXPECT_LT(within(plain.chart, motion.impacts[0]), 300);
    EXPECT_EQ(fine.chart.back(), 0.7);
}

// A strip that turns from one collision to the next is smooth at any speed of the film.
TEST(FilmTimes, CollisionsHaveRowsOfTheirOwn) {
    SKIP_UNDER_SANITIZERS();
    sim::Result motion;
    const auto add = [&](double from, std::optional<double> to) {
        sim::Impact& next = motion.impacts.emplace_back();
        next.t_start = from, next.t_end = to;
        next.collision = static_cast<int>(motion.impacts.size());
    };
    for (int i = 0; i < 3; ++i) add(0.2 + 0.2 * i, 0.21 + 0.2 * i);
    const FrameSpan span{.fps = {60, 1}};
    const FilmTimes plain = film_times(span, 1, motion, motion.impacts),
                    fine = film_times(span, 1, motion, motion.impacts, true);
    EXPECT_EQ(plain.frames, fine.frames);
    EXPECT_EQ(plain.trace, fine.trace);
    EXPECT_TRUE(std::is_sorted(fine.chart.begin(), fine.chart.end()));
    EXPECT_EQ(std::adjacent_find(fine.chart.begin(), fine.chart.end()), fine.chart.end());
    const auto within = [](const std::vector<double>& all, double from, double to) {
        return std::lower_bound(all.begin(), all.end(), to) - std::lower_bound(all.begin(), all.end(), from);
    };
    for (const sim::Impact& i : motion.impacts) {
        EXPECT_LT(within(plain.chart, i.t_start, *i.t_end), 50);
        EXPECT_GT(within(fine.chart, i.t_start, *i.t_end), 450);
    }
    // Very many of them, the last of which never ends.
    motion.impacts.clear();
    for (int i = 0; i < 100'000; ++i) add(1e-5 * i, 1e-5 * (i + 0.5));
    add(1, std::nullopt);
    EXPECT_LT(film_times(span, 1, motion, motion.impacts, true).chart.size(), 600'000u);
}

TEST(FilmTimes, TextIsShownAsLongAsTheFreeze) {
    const FilmTimes times =
        film_times({.fps = {10, 1}, .events = {{.at = {.t = 0.5}, .freeze = 2, .text = "now", .show = 1}}}, 1, {}, {});
    ASSERT_EQ(times.callouts.size(), 1u);
    EXPECT_EQ(times.callouts[0].first, 5);
    EXPECT_EQ(times.callouts[0].last, 25);
    EXPECT_EQ(times.frames.size(), 30u);
}

TEST(FilmTimes, TextsOfOneInstantFollowEachOther) {
    const FilmTimes times =
        film_times({.fps = {10, 1}, .events = {{{.t = 0.5}, 2, "first", 1}, {{.t = 0.5}, 1, "second", 1}}}, 1, {}, {});
    ASSERT_EQ(times.callouts.size(), 2u);
    EXPECT_EQ(times.callouts[0].first, 5);
    EXPECT_EQ(times.callouts[0].last, 24);  // one text at a time
    EXPECT_EQ(times.callouts[1].first, 25);
    EXPECT_EQ(times.callouts[1].last, 35);
    EXPECT_EQ(times.frames.size(), 40u);
}

}  // namespace
}  // namespace beamcam::scenes
