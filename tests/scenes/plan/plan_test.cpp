#include "scenes/plan/plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "scenes/scene/files.hpp"
#include "sim/observe/recorder.hpp"
#include "sim/run/simulate.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::ElementsAre, ::testing::HasSubstr;
using testing::read;

Scene scene_of(const std::string& text) {
    Reading reading = read(text);
    EXPECT_TRUE(reading.scene) << reading.report();
    return *reading.scene;
}

Plan plan_of(const std::string& outputs, const std::string& physics = "") {
    return plan(resolve(scene_of("{" + physics + "\"outputs\": " + outputs + "}"), {}));
}

const sim::Request& run_of(const Plan& p) { return p.motions.at(p.run.value()).request; }

// Of the first motion of the first picture.
const sim::Request& shown_in(const Plan& p) { return p.motions.at(p.pictures.at(0).motions.at(0)).request; }

double end_of_motions(const Plan& p) {
    double end = 0;
    for (const MotionRequest& each : p.motions) end = std::max(end, end_of(each.request));
    return end;
}

std::string text_of(const std::string& scene_text, const ExistingWork& existing = {}) {
    const Scene scene = scene_of(scene_text);
    return to_text(plan(resolve(scene, existing.finished, {}), existing), scene);
}

TEST(Plan, WithoutOutputsNothingIsDone) {
    const Plan p = plan_of("[]");
    EXPECT_TRUE(p.motions.empty());
    EXPECT_TRUE(p.pictures.empty());
    EXPECT_FALSE(p.needs_gl());
}

TEST(Plan, ATableNeedsNeitherPicturesNorOpenGl) {
    const Plan p = plan_of(R"([{"type": "trajectory", "channels": ["theta"], "times": [0.3, 0.1]}])");
    EXPECT_TRUE(p.pictures.empty());
    EXPECT_FALSE(p.needs_gl());
    ASSERT_EQ(p.motions.size(), 1u);
    EXPECT_TRUE(run_of(p).poses.empty());
    EXPECT_TRUE(run_of(p).extrema.empty());
    ASSERT_EQ(run_of(p).tables.size(), 1u);
    EXPECT_THAT(run_of(p).tables[0].times, ElementsAre(0.3, 0.1));
    EXPECT_THAT(run_of(p).tables[0].channels,
                ElementsAre(sim::Channel{sim::ChannelKind::t, 0}, sim::Channel{sim::ChannelKind::theta, 0}));
}

TEST(Plan, MotionsEndWhereTheLastOutputLooks) {
    const auto end = [](const char* outputs) { return end_of_motions(plan_of(outputs)); };
    EXPECT_EQ(end(R"([{"type": "still", "at": 0.3}])"), 1.5);  // its scales are those of the scene
    EXPECT_EQ(end(R"([{"type": "video", "to": 0.5}, {"type": "trajectory", "times": [0.7]}])"), 0.7);
    EXPECT_EQ(end(R"([{"type": "video", "to": 0.5}])"), 0.5);
    EXPECT_EQ(end(R"([{"type": "video", "to": 0.5}, {"type": "impacts"}])"), 1.5);
    EXPECT_EQ(end(R"([{"type": "trajectory", "times": [2.5]}])"), 2.5);
}

// Impacts are those of the whole run.
TEST(Plan, ImpactsReachAsFarAsTheLongestTable) {
    EXPECT_EQ(run_of(plan_of(R"([{"type": "impacts"}, {"type": "trajectory", "times": [2.5]}])")).end_time, 2.5);
}

TEST(Plan, FramesAreAtMultiplesOfTheFramePeriod) {
    const Plan p = plan_of(R"([{"type": "frames", "fps": 10, "from": 0.2, "to": 0.5}])");
    EXPECT_EQ(p.pictures[0].times.first, 2);
    EXPECT_THAT(shown_in(p).poses[kFramePoses].times, ElementsAre(2 / 10.0, 3 / 10.0, 4 / 10.0));
    EXPECT_EQ(plan_of(R"([{"type": "video"}])", R"("time": {"end": 10},)").pictures.front().draw.size(), 600u);
    EXPECT_EQ(plan_of(R"([{"type": "video", "fps": 29.97}])", R"("time": {"end": 10},)").pictures.front().draw.size(),
              300u);
}

TEST(Plan, TableRowsAreMultiplesOfThePeriodAndTheEnd) {
    const auto rows = [](const char* end) {
        return run_of(
                   plan_of(R"([{"type": "trajectory", "rate": 10}])", std::string("\"time\": {\"end\": ") + end + "},"))
            .tables[0]
            .times;
    };
    EXPECT_THAT(rows("0.3"), ElementsAre(0, 1 / 10.0, 2 / 10.0, 0.3));
    EXPECT_THAT(rows("0.25"), ElementsAre(0, 1 / 10.0, 2 / 10.0, 0.25));
    EXPECT_THAT(rows("0.05"), ElementsAre(0, 0.05));
    EXPECT_THAT(
        run_of(plan_of(R"([{"type": "trajectory", "rate": 1e-9}])", R"("time": {"end": 0.5},)")).tables[0].times,
        ElementsAre(0, 0.5));
}

// Of ten seconds, in which rows at equal distances of time miss the peaks of the third mode.
TEST(Plan, ThePhasePortraitReachesThePeaksOfVibration) {
    const Plan p = plan_of(R"([{"type": "still", "at": 9.99, "layout": "phase"}])",
                           R"("time": {"end": 10}, "beam": {"modes": 3},)");
    const sim::Table drawn = sim::simulate(p.motions[0].problem, shown_in(p)).tables[kChartTable];
    const auto column = [&](sim::ChannelKind kind) {
        const auto at = std::ranges::find(drawn.channels, sim::Channel{kind, 0}) - drawn.channels.begin();
        return drawn.values.at(static_cast<std::size_t>(at));
    };
    const std::vector<double> t = column(sim::ChannelKind::t), rate = column(sim::ChannelKind::theta_dot);
    sim::Request all;
    all.tables.push_back({{}, {{sim::ChannelKind::theta_dot, 0}}});
    for (double at = 0.8426; at < 0.8434; at += 1e-6) all.tables.front().times.push_back(at);
    const double peak = std::ranges::max(sim::simulate(p.motions[0].problem, all).tables.front().values.front());
    double reached = 0;
    for (std::size_t i = 0; i < t.size(); ++i)
        if (t[i] > 0.8426 && t[i] < 0.8434) reached = std::max(reached, rate[i]);
    EXPECT_NEAR(reached, peak, 2e-3 * (std::ranges::max(rate) - std::ranges::min(rate)));
}

TEST(Plan, AFlatViewNeedsNoOpenGl) {
    EXPECT_FALSE(plan_of(R"([{"type": "video", "view": {"style": "flat"}}])").needs_gl());
    EXPECT_TRUE(plan_of(R"([{"type": "video"}])").needs_gl());
}

TEST(Plan, WithoutACamThereIsNoTraceOfTheContact) {
    EXPECT_EQ(shown_in(plan_of(R"([{"type": "video"}])", "\"cam\": null,")).tables.size(), kTraceTable);
    EXPECT_EQ(shown_in(plan_of(R"([{"type": "video"}])")).tables.size(), kTraceTable + 1);
}

TEST(Plan, OneMotionServesEveryOutput) {
    const Plan p = plan_of(
        R"([{"type": "video", "file": "a.mp4"}, {"type": "still", "at": 0.2}, {"type": "trajectory"}, {"type": "summary"}])");
    ASSERT_EQ(p.motions.size(), 3u);  // requests of each picture, and of the table and the summary
    for (const MotionRequest& each : p.motions) EXPECT_EQ(each.key, p.motions.front().key);
    EXPECT_EQ(run_of(p).tables.size(), 1u);
}

// ---- golden texts ------------------------------------------------------------------------------

TEST(PlanText, AFilm) {
    EXPECT_EQ(text_of(R"({"time": {"end": 10}, "outputs": [{"type": "video", "poster": 0.3}]})"),
              R"(motion      first-order, 2 modes: until 10 s
video       scene.mp4: 600 frames
            scene.png
)");
}

TEST(PlanText, ATableOfTheRigidBeamWithoutACam) {
    EXPECT_EQ(
        text_of(
            R"({"cam": null, "beam": {"model": "rigid"}, "outputs": [{"type": "trajectory", "channels": ["theta"], "times": [0.37]}]})"),
        R"(motion      rigid: until 0.37 s
trajectory  scene.csv: 1 row
)");
}

TEST(PlanText, AFlatStillOfTheStart) {
    EXPECT_EQ(text_of(R"({"outputs": [{"type": "still", "at": 0, "view": {"style": "flat"}, "size": [800, 600]}]})"),
              R"(motion      first-order, 2 modes: until 1.5 s
still       scene.png
)");
}

TEST(PlanText, EveryOutputAtOnce) {
    EXPECT_EQ(
        text_of(
            R"({"beam": {"model": "exact", "modes": 6}, "outputs": [{"type": "frames", "fps": 30, "from": 0.5}, {"type": "trajectory"}, {"type": "impacts"}, {"type": "summary", "horizon": true}, {"type": "figure", "figure": "series", "file": "s.pdf", "channels": ["theta"], "data": "s.csv"}]})"),
        R"(motion      exact, 6 modes: until 1.5 s, compared with a second run
frames      scene-####.png: 30 frames
figure      s.pdf: series
            s.csv
trajectory  scene.csv: rows that follow the motion
impacts     scene-impacts.json
summary     scene-summary.json
)");
}

TEST(PlanText, ASweep) {
    EXPECT_EQ(text_of(R"({"sweep": {"over": [{"key": "cam.speed", "from": 40, "to": 52, "count": 7}],
        "seed": {"random": 3}}, "outputs": [{"type": "sweep", "file": "s.csv"}]})"),
              R"(sweep       cam.speed: 21 points
sweep       s.csv
)");
}

TEST(PlanText, AnOutputAtAnEventWaitsForIt) {
    const Scene scene =
        scene_of(R"({"time": {"end": 2}, "outputs": [{"type": "video", "file": "a.mp4", "to": "impact:3"}]})");
    Plan dry;
    dry.waiting = {0};
    EXPECT_EQ(to_text(dry, scene), "video       a.mp4: at events, found by a run until 2 s at most\n");
}

TEST(PlanText, IsTheSameAsJson) {
    const Scene scene = scene_of(R"({"outputs": [{"type": "trajectory"}]})");
    EXPECT_EQ(to_json(plan(resolve(scene, {})), scene), R"([
  {"what": "motion", "name": "first-order, 2 modes", "content": "until 1.5 s"},
  {"what": "trajectory", "name": "scene.csv", "content": "rows that follow the motion"}
]
)");
}

// ---- in the light of what is there -------------------------------------------------------------

constexpr const char* kTwo = R"({"outputs": [
    {"type": "frames", "file": "f-##.png", "fps": 20, "to": 0.5, "size": [320, 180], "view": {"style": "flat"}},
    {"type": "trajectory", "file": "t.csv", "times": [0.4]}]})";

TEST(PlanText, WhatIsUpToDateIsKept) {
    ExistingWork existing;
    existing.finished = {1};
    existing.frames[0] = {0, 1, 2, 7};
    EXPECT_EQ(text_of(kTwo, existing), R"(motion      first-order, 2 modes: until 0.5 s
frames      f-##.png: 6 frames
kept        t.csv
kept        4 frames of f-##.png
)");
    existing.finished = {1};
    existing.frames[0] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    EXPECT_EQ(text_of(kTwo, existing), R"(kept        t.csv
kept        10 frames of f-##.png
)");
}

TEST(PlanText, MotionsThatPicturesCompareAreSimulatedOnce) {
    EXPECT_EQ(text_of(R"({"outputs": [
        {"type": "still", "file": "a.png", "at": 0.3, "view": {"style": "flat"},
         "compare": [{"label": "slow"}, {"label": "fast", "set": {"cam.speed": 5}}]},
        {"type": "still", "file": "b.png", "at": 0.4, "view": {"style": "flat"},
         "compare": [{"label": "slow"}, {"label": "fast", "set": {"cam.speed": 5}}]}]})"),
              R"(motion      first-order, 2 modes: until 1.5 s, "slow"
motion      first-order, 2 modes: until 1.5 s, "fast"
still       a.png
still       b.png
)");
}

TEST(Plan, PicturesThatEndBeforeTheRunReportOnlyTheirPart) {
    const Plan p = plan_of(R"([{"type": "video", "file": "a.mp4", "to": 0.5}, {"type": "video", "file": "b.mp4"}])");
    std::vector<double> ends;
    for (const MotionRequest& each : p.motions) ends.push_back(each.request.end_time);
    EXPECT_THAT(ends, ElementsAre(0.5, 1.5));
}

}  // namespace
}  // namespace beamcam::scenes
