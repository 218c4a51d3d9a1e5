#include "scenes/plan/plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "scenes/motions/identity.hpp"
#include "scenes/scene/files.hpp"
#include "sim/run/simulate.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::Contains, ::testing::ElementsAre, ::testing::HasSubstr;
using testing::read;

Scene scene_of(const std::string& text) {
    Reading reading = read(text);
    EXPECT_TRUE(reading.scene) << reading.report();
    return *reading.scene;
}

Plan plan_of(const std::string& outputs, const std::string& physics = "") {
    return plan(scene_of("{" + physics + "\"outputs\": " + outputs + "}"));
}

const sim::Request& shown_by(const Pictures& pictures) { return pictures.shown.front().request; }

std::string text_of(const std::string& scene_text) {
    const Scene scene = scene_of(scene_text);
    return to_text(plan(scene));
}

TEST(Plan, WithoutOutputsNothingIsDone) {
    const Plan p = plan_of("[]");
    EXPECT_FALSE(p.simulation);
    EXPECT_TRUE(p.pictures.empty());
    EXPECT_FALSE(p.needs_gl());
    EXPECT_FALSE(p.needs_encoder());
}

TEST(Plan, ATableNeedsNeitherPicturesNorEncoderNorOpenGl) {
    const Plan p = plan_of(R"([{"type": "trajectory", "channels": ["theta"], "times": [0.3, 0.1]}])");
    EXPECT_TRUE(p.pictures.empty());
    EXPECT_FALSE(p.needs_gl());
    EXPECT_FALSE(p.needs_encoder());
    EXPECT_TRUE(p.simulation->request.poses.empty());
    EXPECT_TRUE(p.simulation->request.extrema.empty());
    ASSERT_EQ(p.simulation->request.tables.size(), 1u);
    EXPECT_THAT(p.simulation->request.tables[0].times, ElementsAre(0.3, 0.1));
    EXPECT_THAT(p.simulation->request.tables[0].channels,
                ElementsAre(sim::Channel{sim::ChannelKind::t, 0}, sim::Channel{sim::ChannelKind::theta, 0}));
}

TEST(Plan, SimulationEndsWhereTheLastOutputLooks) {
    EXPECT_EQ(plan_of(R"([{"type": "still", "at": 0.3}])").simulation->request.end_time, 0.3);
    EXPECT_EQ(plan_of(R"([{"type": "still", "at": 0.3}, {"type": "trajectory", "times": [0.7]}])")
                  .simulation->request.end_time,
              0.7);
    EXPECT_EQ(plan_of(R"([{"type": "video", "to": 0.5}])").simulation->request.end_time, 0.5);
    EXPECT_EQ(plan_of(R"([{"type": "still", "at": 0.3}, {"type": "impacts"}])").simulation->request.end_time, 1.5);
    EXPECT_EQ(plan_of(R"([{"type": "trajectory", "times": [2.5]}])").simulation->request.end_time, 2.5);
    EXPECT_EQ(plan_of(R"([{"type": "still", "at": 0}])").simulation->request.end_time, 0);
}

TEST(Plan, FramesAreAtMultiplesOfTheFramePeriod) {
    const Plan p = plan_of(R"([{"type": "frames", "fps": 10, "from": 0.2, "to": 0.5}])");
    EXPECT_EQ(p.pictures[0].first_frame, 2);
    EXPECT_THAT(shown_by(p.pictures[0]).poses[kFramePoses].times, ElementsAre(2 / 10.0, 3 / 10.0, 4 / 10.0));
    EXPECT_EQ(plan_of(R"([{"type": "video"}])", R"("time": {"end": 10},)").pictures.front().draw.size(), 600u);
    EXPECT_EQ(plan_of(R"([{"type": "video", "fps": 29.97}])", R"("time": {"end": 10},)").pictures.front().draw.size(),
              300u);
}

TEST(Plan, TableRowsAreMultiplesOfThePeriodAndTheEnd) {
    const auto rows = [](const char* end) {
        return plan_of(R"([{"type": "trajectory", "rate": 10}])", std::string("\"time\": {\"end\": ") + end + "},")
            .simulation->request.tables[0]
            .times;
    };
    EXPECT_THAT(rows("0.3"), ElementsAre(0, 1 / 10.0, 2 / 10.0, 0.3));
    EXPECT_THAT(rows("0.25"), ElementsAre(0, 1 / 10.0, 2 / 10.0, 0.25));
    EXPECT_THAT(rows("0.05"), ElementsAre(0, 0.05));
    EXPECT_THAT(plan_of(R"([{"type": "trajectory", "rate": 1e-9}])", R"("time": {"end": 0.5},)")
                    .simulation->request.tables[0]
                    .times,
                ElementsAre(0, 0.5));
}

// Of ten seconds, in which rows at equal distances of time miss the peaks of the third mode.
TEST(Plan, ThePhasePortraitReachesThePeaksOfVibration) {
    const Plan p = plan_of(R"([{"type": "still", "at": 9.99, "layout": "phase"}])",
                           R"("time": {"end": 10}, "beam": {"modes": 3},)");
    const sim::Table drawn =
        sim::simulate(p.pictures[0].shown.front().problem, shown_by(p.pictures[0])).tables[kChartTable];
    const auto column = [&](sim::ChannelKind kind) {
        const auto at = std::ranges::find(drawn.channels, sim::Channel{kind, 0}) - drawn.channels.begin();
        return drawn.values.at(static_cast<std::size_t>(at));
    };
    const std::vector<double> t = column(sim::ChannelKind::t), rate = column(sim::ChannelKind::theta_dot);
    sim::Request all;
    all.tables.push_back({{}, {{sim::ChannelKind::theta_dot, 0}}});
    for (double at = 0.8426; at < 0.8434; at += 1e-6) all.tables.front().times.push_back(at);
    const double peak =
        std::ranges::max(sim::simulate(p.pictures[0].shown.front().problem, all).tables.front().values.front());
    double reached = 0;
    for (std::size_t i = 0; i < t.size(); ++i)
        if (t[i] > 0.8426 && t[i] < 0.8434) reached = std::max(reached, rate[i]);
    EXPECT_NEAR(reached, peak, 2e-3 * (std::ranges::max(rate) - std::ranges::min(rate)));
}

TEST(Plan, AFlatViewNeedsNoOpenGl) {
    EXPECT_FALSE(plan_of(R"([{"type": "video", "view": {"style": "flat"}}])").needs_gl());
    EXPECT_TRUE(plan_of(R"([{"type": "video"}])").needs_gl());
    EXPECT_FALSE(plan_of(R"([{"type": "still", "at": 0}])").needs_encoder());
}

TEST(Plan, WithoutACamThereIsNoTraceOfTheContact) {
    EXPECT_EQ(shown_by(plan_of(R"([{"type": "video"}])", "\"cam\": null,").pictures[0]).tables.size(), kTraceTable);
    EXPECT_EQ(shown_by(plan_of(R"([{"type": "video"}])").pictures[0]).tables.size(), kTraceTable + 1);
}

TEST(Plan, OneSimulationServesEveryOutput) {
    const Plan p = plan_of(
        R"([{"type": "video", "file": "a.mp4"}, {"type": "still", "at": 0.2}, {"type": "trajectory"}, {"type": "summary"}])");
    EXPECT_TRUE(p.others.empty());
    EXPECT_EQ(p.simulation->request.tables.size(), 1u);
    EXPECT_EQ(requests_of(p).size(), 3u);  // of the table and the summary, and of each picture
}

TEST(Plan, TheHorizonThatAPictureShowsDoesNotChangeTheSummary) {
    const Plan p = plan_of(R"([{"type": "video", "horizon": true}, {"type": "summary"}])");
    EXPECT_TRUE(shown_by(p.pictures[0]).horizon);
    EXPECT_FALSE(p.simulation->request.horizon);
    EXPECT_TRUE(p.simulation->horizon);
}

// Events decide when the frames are, not how many.
TEST(Plan, AFilmWithADurationHasAKnownNumberOfFrames) {
    const Scene scene =
        scene_of(R"({"outputs": [{"type": "video", "file": "a.mp4", "fps": 20, "duration": 3, "from": "impact:1"}]})");
    const Plan whole = plan(scene);
    EXPECT_THAT(to_text(whole), HasSubstr("a.mp4: 60 frames from impact 1 to 1.5 s at 20 per second, 1920 × 1080"));
    EXPECT_THAT(to_json(whole), HasSubstr("\"frames\": 60,"));
    const Plan part = plan(scene, {.frames = std::pair(10L, 15L)});
    EXPECT_THAT(to_text(part), HasSubstr("a.mp4: 5 frames from impact 1"));
    EXPECT_THAT(to_text(part), HasSubstr("55 of 60 frames of a.mp4: outside the selected frames"));
    const auto slow = R"([{"type": "video", "speed": "impacts"}])";
    EXPECT_THAT(to_text(plan_of(slow)), HasSubstr("their number depends on the events"));
}

// ---- golden texts ------------------------------------------------------------------------------

// ALL-4: the number of channels beside the time, less four, whatever channels there are.
std::string counted_in(std::string text, const sim::Problem& problem = {}) {
    const std::size_t all = sim::all_channels(problem).size() - 1;
    for (const auto& [name, count] :
         {std::pair{"ALL-4", all - 4}, {"ALL-1", all - 1}, {"ALL+1", all + 1}, {"ALL", all}})
        replace_all(text, name, std::to_string(count));
    return text;
}

TEST(PlanText, AFilm) {
    EXPECT_EQ(text_of(R"({"time": {"end": 10}, "outputs": [{"type": "video"}]})"), counted_in(R"(to do
  simulate  first-order, 2 hub-beam modes, compliant contact; until 10 s, needed by scene.mp4
  video     scene.mp4: 600 frames from 0 s to 9.98333 s at 60 per second, 1920 × 1080, lit; H.264, crf 18, veryfast
skipped
  ALL-4 of ALL channels: no output needs them
  extrema and zero crossings: no output is a summary
  further runs for the reproducible horizon: no output needs it
)"));
}

TEST(PlanText, ATableOfTheRigidBeamWithoutACam) {
    EXPECT_EQ(
        text_of(
            R"({"cam": null, "beam": {"model": "rigid"}, "outputs": [{"type": "trajectory", "channels": ["theta"], "times": [0.37]}]})"),
        counted_in(R"(to do
  simulate  rigid, no contact; until 0.37 s, needed by scene.csv
  table     scene.csv: 1 row of 2 channels
skipped
  simulation from 0.37 s to 1.5 s: no output needs it
  contact: the scene has no cam
  ALL-1 of ALL channels: no output needs them
  pictures, fonts and OpenGL: no output is a picture
  video encoder: no output is a video
  extrema and zero crossings: no output is a summary
  further runs for the reproducible horizon: no output needs it
)",
                   scene_of(R"({"cam": null, "beam": {"model": "rigid"}})").problem));
}

TEST(PlanText, AFlatStillOfTheStart) {
    EXPECT_EQ(text_of(R"({"outputs": [{"type": "still", "at": 0, "view": {"style": "flat"}, "size": [800, 600]}]})"),
              counted_in(R"(to do
  simulate  first-order, 2 hub-beam modes, compliant contact; the initial state only, without integration
  still     scene.png: one picture at 0 s, 800 × 600, flat
skipped
  simulation from 0 s to 1.5 s: no output needs it
  ALL-4 of ALL channels: no output needs them
  OpenGL: every view is flat
  video encoder: no output is a video
  extrema and zero crossings: no output is a summary
  further runs for the reproducible horizon: no output needs it
)"));
}

TEST(PlanText, WhatAPictureHasNoRoomToWriteIsNamed) {
    const Scene scene = scene_of(
        R"({"title": "Fall", "outputs": [{"type": "still", "file": "a.png", "at": 0, "size": [320, 180]}, {"type": "still", "file": "b.png", "at": 0}]})");
    Plan p = plan(scene);
    add_omitted_text(p, scene);
    EXPECT_THAT(
        to_text(p),
        HasSubstr("skipped\n  L = 1 m; R = 100 mm; e = 20 mm; first-order, 2 modes; K = 10⁸ N m^−1.5, c_r = 0.7; "
                  "frictionless; colour scales on a.png: 320 × 180 is too small for them; increase \"size\"\n"
                  "  simulation from 0 s"));
}

TEST(PlanText, EveryOutputAtOnce) {
    EXPECT_EQ(
        text_of(
            R"({"beam": {"model": "exact", "modes": 6}, "outputs": [{"type": "frames", "fps": 30, "from": 0.5}, {"type": "trajectory"}, {"type": "impacts"}, {"type": "summary", "horizon": true}]})"),
        counted_in(R"(to do
  simulate  exact, 6 shape functions, compliant contact; until 1.5 s, needed by scene-####.png; further runs find the reproducible horizon
  frames    scene-####.png: 30 frames from 0.5 s to 1.46667 s at 30 per second, 1920 × 1080, lit
  table     scene.csv: 1501 rows of ALL+1 channels
  impacts   scene-impacts.json
  summary   scene-summary.json
skipped
  video encoder: no output is a video
)",
                   scene_of(R"({"beam": {"model": "exact", "modes": 6}})").problem));
}

// ---- in the light of what is there -------------------------------------------------------------

constexpr const char* kTwo = R"({"outputs": [
    {"type": "frames", "file": "f-##.png", "fps": 20, "to": 0.5, "size": [320, 180], "view": {"style": "flat"}},
    {"type": "trajectory", "file": "t.csv", "times": [0.4]}]})";

std::string text_with(const ExistingWork& existing, const Selection& selection = {}) {
    const Scene scene = scene_of(kTwo);
    return to_text(plan(scene, selection, existing));
}

TEST(PlanText, WhatIsThereIsLeftAndAKeptMotionIsRead) {
    ExistingWork existing;
    existing.finished = {{1, "t.csv"}};
    existing.frames[0] = {0, 1, 2, 7};
    existing.keeps = true;
    double& kept_until = existing.kept_until[motion_key(scene_of(kTwo).problem)];
    kept_until = 0.6;
    EXPECT_EQ(text_with(existing), counted_in(R"(to do
  simulate  first-order, 2 hub-beam modes, compliant contact; until 0.5 s, needed by f-##.png; from the cache
  frames    f-##.png: 6 frames from 0.15 s to 0.45 s at 20 per second, 320 × 180, flat
skipped
  4 frames of f-##.png: up to date
  t.csv: up to date
  simulation from 0.5 s to 1.5 s: no output needs it
  integration: the motion is in the cache
  ALL-4 of ALL channels: no output needs them
  OpenGL: every view is flat
  video encoder: no output is a video
  extrema and zero crossings: no output is a summary
  further runs for the reproducible horizon: no output needs it
)"));
    kept_until = 0.4;  // too short
    EXPECT_THAT(text_with(existing),
                HasSubstr("needed by f-##.png; added to the cache, unless it is short or too large\n"));
    existing.finished = {{0, "f-##.png"}, {1, "t.csv"}};
    EXPECT_EQ(text_with(existing), R"(to do
skipped
  f-##.png: up to date
  t.csv: up to date
  simulation: all outputs are up to date
)");
}

TEST(PlanText, AShardDrawsItsPartAndTheFirstMakesTheRest) {
    const std::string text = text_with({}, {.shard = {2, 3}});
    EXPECT_THAT(text, HasSubstr("f-##.png: 3 frames from 0.15 s to 0.25 s"));
    EXPECT_THAT(text, HasSubstr("  7 of 10 frames of f-##.png: other shards draw them\n"));
    EXPECT_THAT(text, HasSubstr("  t.csv: the first shard writes it\n"));
}

TEST(Plan, ShardsCoverEveryFrameOnce) {
    const Scene scene = scene_of(R"({"outputs": [{"type": "video", "fps": 20, "from": 0.3}]})");
    for (const std::uint64_t count : {1, 2, 3, 7, 24}) {
        std::vector<int> all;
        for (std::uint64_t number = 1; number <= count; ++number) {
            const Plan p = plan(scene, {.shard = {number, count}});
            ASSERT_EQ(p.pictures.size(), 1u);
            all.insert(all.end(), p.pictures[0].draw.begin(), p.pictures[0].draw.end());
            // Scales and camera are those of the whole film.
            EXPECT_EQ(shown_by(p.pictures[0]).poses[kFramePoses].times.size(), 24u);
        }
        EXPECT_EQ(all.size(), 24u);
        EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
    }
    EXPECT_TRUE(plan(scene_of(R"({"outputs": [{"type": "video", "fps": 1}]})"), {.shard = {25, 30}}).pictures.empty());
    EXPECT_EQ(shard_file("out/fall.mp4", {2, 3}), "out/fall.2of3.mp4");
}

TEST(Plan, PicturesThatEndBeforeTheRunReportOnlyTheirPart) {
    const Plan p = plan_of(
        R"([{"type": "video", "file": "a.mp4", "to": 0.5}, {"type": "video", "file": "b.mp4"}, {"type": "still", "at": 0.5}])");
    std::vector<double> ends;
    for (const sim::Request& request : requests_of(p)) ends.push_back(request.end_time);
    EXPECT_THAT(ends, ElementsAre(1.5, 0.5, 1.5, 0.5));  // of the run, then of each picture
}

}  // namespace
}  // namespace beamcam::scenes
