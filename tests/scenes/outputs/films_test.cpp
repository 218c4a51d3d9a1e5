// Films of real motions: what is drawn touching touches, and files do not depend on threads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "render/mechanism/exaggeration.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/scene/film_times.hpp"
#include "sim/run/simulate.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Folder, testing::Finished, testing::shell;
using ::testing::HasSubstr, ::testing::Not;

// Distance of the drawn face, as the polygon that is filled, from the drawn disc.
double drawn_gap(const render::DrawnBeam& beam, const sim::Pose& pose, double radius) {
    double best = 1e300;
    for (std::size_t i = 0; i + 1 < beam.line.size(); ++i) {
        const sim::Vec2 a = beam.face(i), ab = beam.face(i + 1) - a;
        const double s = std::clamp(dot(pose.disc_centre - a, ab) / dot(ab, ab), 0.0, 1.0);
        best = std::min(best, norm(a + ab * s - pose.disc_centre));
    }
    return best - radius;
}

// Frames in contact of a film at real speed and, between first touch and last release, twenty for each millisecond.
void touches_within_half_a_pixel(const std::string& overrides, double wanted_factor) {
    const Reading reading = testing::read("{" + overrides + "\"time\": {\"end\": 1}}");
    ASSERT_TRUE(reading.scene) << reading.report();
    const sim::Problem& problem = reading.scene->problem;
    sim::Request all;
    all.end_time = 1;
    const sim::Result first = sim::simulate(problem, all);
    ASSERT_FALSE(first.impacts.empty());
    sim::PoseRequest request;
    for (int k = 0; k < 60; ++k) request.times.push_back(k / 60.0);
    for (const sim::Impact& impact : first.impacts)
        for (double t = impact.t_start; t < impact.t_end.value_or(1); t += 5e-5) request.times.push_back(t);
    std::ranges::sort(request.times);
    all.poses = {request};
    const sim::Result motion = sim::simulate(problem, all);
    const std::vector<sim::Pose>& poses = motion.poses[0];
    const double factor = render::film_factor(
        problem, poses.size(), [&](std::size_t k) { return poses[k]; },
        wanted_factor > 0 ? std::optional(wanted_factor) : std::nullopt);
    constexpr double kPixel = 1.0 / 950;  // [m], of a film 1920 pixels wide
    int touching = 0;
    for (const sim::Pose& pose : poses) {
        const render::DrawnBeam beam = render::drawn_beam(problem, pose, factor, beam_depth(problem.beam));
        const double gap = drawn_gap(beam, pose, problem.cam->radius);
        // Penetration is real: the drawing may show as much of it as there is, and no more.
        EXPECT_GT(gap, std::min(pose.nearest->gap, 0.0) - 0.5 * kPixel) << "t = " << pose.t << ", ×" << factor;
        if (!pose.nearest->touching) continue;
        ++touching;
        EXPECT_LT(std::abs(gap), std::abs(pose.nearest->gap) + 0.5 * kPixel) << "t = " << pose.t << ", ×" << factor;
    }
    EXPECT_GT(touching, 100);
}

TEST(Films, TouchingIsDrawnTouchingAtEveryFrameInContact) {
    SKIP_UNDER_SANITIZERS();
    touches_within_half_a_pixel("\"beam\": {\"modes\": 4}, \"cam\": {\"speed\": 5},", 0);
    touches_within_half_a_pixel("\"beam\": {\"modes\": 4}, \"cam\": {\"speed\": 0},", 100);
    touches_within_half_a_pixel("\"contact\": {\"offset\": \"half-depth\"},", 50);
}

TEST(Films, WhatStandsStillIsNeitherDrawnNorConvertedAgain) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    folder.write("s.json",
                 R"({"time": {"end": 0.3}, "outputs": [{"type": "video", "file": "f.mkv", "size": [320, 180], "fps": 20,
        "from": 0.2, "poster": "impact:1", "view": {"style": "flat"}, "events": [{"at": "impact:1", "freeze": 2, "text": "touch"}]}]})");
    std::string pictures;
    for (const char* jobs : {"1", "3"}) {
        const Finished made = shell(folder, std::string("$BEAMCAM run s.json -v -j ") + jobs + " -o j" + jobs);
        ASSERT_EQ(made.code, 0) << made.err;
        EXPECT_THAT(made.err,
                    HasSubstr("frames_repeated=38 "));  // all frozen frames but the first, whose ring does not age, and
                                                        // the poster, which is always drawn
        const std::string found = shell(folder, std::string("picture_hash j") + jobs + "/f.mkv | cut -c1-64").out;
        EXPECT_TRUE(pictures.empty() || found == pictures);
        pictures = found;
    }
    ASSERT_EQ(shell(folder,
                    "sed -i 's/f.mkv/f-##.png/; s/video/frames/; s/\"poster\": \"impact:1\",//' s.json && $BEAMCAM run "
                    "s.json -q")
                  .code,
              0);
    EXPECT_EQ(shell(folder, "picture_hash j1/f.mkv | cut -c1-64").out,
              shell(folder, "picture_hash f-*.png | cut -c1-64").out);
}

TEST(Films, SlowMotionFilesDoNotDependOnThreads) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.3}, "outputs": [{"type": "frames", "file": "f-###.png",
        "size": [960, 540], "fps": 12, "from": 0.27, "view": {"style": "flat"},
        "speed": {"around": "impacts", "factor": 0.02, "ease": "5 ms"}, "events": [{"at": "impact:1", "freeze": 0.5, "text": "touch"}],
        "layout": {"columns": ["mechanism", {"rows": [{"panel": "contact_force", "window": "collision"}, "close-up"]}]}}]})");
    std::string listing;
    for (const char* jobs : {"1", "3"}) {
        const Finished finished = shell(folder, std::string("$BEAMCAM run s.json -j ") + jobs + " -o j" + jobs);
        ASSERT_EQ(finished.code, 0) << finished.err;
    }
    EXPECT_EQ(shell(folder, "diff -r -x .beamcam.jsonl j1 j3").out, "");
    const int frames = std::stoi(shell(folder, "ls j1/*.png | wc -l").out);
    EXPECT_GT(frames, 8);
}

TEST(Films, AStillOfAnImpactStandsAtItsTouch) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.5}, "outputs": [{"type": "still", "at": "impact:1", "size": [320, 180],
        "view": {"style": "flat"}}]})");
    EXPECT_EQ(shell(folder, "$BEAMCAM run s.json").code, 0);
    const Finished none = shell(folder, "$BEAMCAM render s.json -o x.png --at impact:99");
    EXPECT_EQ(none.code, 3);
    EXPECT_THAT(none.err, HasSubstr("impact 99 does not occur"));
}

TEST(Films, EventsAreInstantsWhereverATimeIs) {
    const Reading reading = testing::read(R"({"time": {"end": 1}, "outputs": [{"type": "still", "at": "apex:1"},
        {"type": "still", "file": "b.png", "at": "release:2"}, {"type": "still", "file": "c.png", "at": "last"},
        {"type": "frames", "file": "d-##.png", "fps": 50, "from": "touch", "to": "apex:1"}]})");
    ASSERT_TRUE(reading.scene) << reading.report();
    sim::Result motion;
    const Plan made = plan(resolve(*reading.scene, [&](const sim::Problem& problem, const sim::Request& request) {
        return motion = sim::simulate(problem, request);
    }));
    ASSERT_GE(motion.impacts.size(), 2u);
    double highest = 0, apex = 0;  // of the first rebound, by every apex of the ripple
    for (const sim::Apex& each : motion.apexes)
        if (each.t > motion.collisions.at(0).t_start && each.t < motion.collisions.at(1).t_start &&
            each.theta > highest)
            highest = each.theta, apex = each.t;
    EXPECT_GT(apex, 0.4);
    EXPECT_EQ(made.pictures.at(0).times.frames.front(), apex);
    EXPECT_EQ(made.pictures.at(1).times.frames.front(), motion.impacts[1].t_end);
    EXPECT_EQ(made.pictures.at(2).times.frames.front(), 1);
    const std::vector<double>& frames = made.pictures.at(3).times.frames;
    EXPECT_NEAR(frames.front(), motion.impacts[0].t_start, 0.5 / 50);
    EXPECT_NEAR(frames.back(), apex, 1.5 / 50);
    EXPECT_THAT(to_json(*reading.scene), HasSubstr("\"from\": \"impact:1\""));
}

TEST(Films, AnEventThatDoesNotHappenIsRefusedWithTheCount) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.1}, "outputs": [{"type": "still", "at": 0, "size": [96, 96],
        "view": {"style": "flat"}}]})");
    EXPECT_THAT(shell(folder, "$BEAMCAM render s.json -o x.png --at apex:3").err,
                HasSubstr("apex 3 does not occur: the motion has 0 of them until 0.1 s; a larger time.end, or \"to\" "
                          "of a film, may"));
    EXPECT_THAT(shell(folder, "$BEAMCAM render s.json -o x-##.png --from release --to last").err,
                HasSubstr("release 1 does not occur: the motion has 0"));
    const Finished wrong = shell(folder, "$BEAMCAM render s.json -o x.png --at impact:0");
    EXPECT_EQ(wrong.code, 2);
    EXPECT_THAT(wrong.err, HasSubstr("is no event; they are counted from 1"));
    EXPECT_THAT(shell(folder, "$BEAMCAM render s.json -o x.png --at peek:1").err, HasSubstr("impact:N, release:N"));
}

TEST(Films, OptionsOfTimeReplaceTheStoryOfTheScene) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    folder.write("s.json",
                 R"({"time": {"end": 0.4}, "outputs": [{"type": "video", "file": "a.mp4", "story": "impact"}]})");
    for (const char* options : {"-o a.mp4 --to 0.4 --speed impacts", "-o a.mp4 --speed 0.5", "-o a.mp4 --duration 2",
                                "-o a-####.png --from 0.2 --to 0.3", "-o a.mp4 --story settle", "-o a.mp4"}) {
        const Finished run = shell(folder, fmt::format("$BEAMCAM render s.json -n {}", options));
        EXPECT_EQ(run.code, 0) << options << run.err;
    }
}

TEST(Films, AStillMayBeVectorGraphics) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.4}, "outputs": [
        {"type": "still", "file": "of-scene.svg", "at": "impact:1", "size": [640, 360], "view": {"style": "flat"}}]})");
    ASSERT_EQ(shell(folder, "$BEAMCAM run s.json").code, 0);
    ASSERT_EQ(shell(folder, "$BEAMCAM render s.json --at impact:1 -o a.svg --size 640x360 --style flat").code, 0);
    ASSERT_EQ(shell(folder, "$BEAMCAM render s.json s.json --at impact:1 -o a.pdf").code, 0);
    const auto drawing = [&](const char* file) {
        const std::string bytes = testing::slurp(folder / file);
        return bytes.substr(bytes.find("</metadata>"));
    };
    EXPECT_EQ(drawing("a.svg"), drawing("of-scene.svg"));
    EXPECT_THAT(testing::slurp(folder / "a.pdf"), ::testing::StartsWith("%PDF"));
    for (const char* wrong : {"-o a.pdf", "--from 0.1 -o a.svg", "--at 0.3 -o a-##.pdf"})
        EXPECT_EQ(shell(folder, fmt::format("$BEAMCAM render s.json {}", wrong)).code, 2) << wrong;
}

// A time may be after the end of the scene, which extends the motion; a slip of the unit is then noticed.
TEST(Films, ATimeAfterTheEndOfTheSceneIsAWarning) {
    const auto warnings_of = [](const std::string& outputs) {
        return testing::read(R"({"time": {"end": 0.1}, "outputs": [)" + outputs + "]}").report();
    };
    const char* late = " = 0.2 s is after the end of the scene, time.end = 0.1 s: the motion is computed until then";
    for (const char* output : {R"({"type": "still", "at": 0.2})", R"({"type": "video", "file": "a.gif", "to": 0.2})",
                               R"({"type": "figure", "figure": "kymograph", "to": 0.2})",
                               R"({"type": "figure", "figure": "strobe", "to": 0.2})"})
        EXPECT_THAT(warnings_of(output), HasSubstr(late)) << output;
    EXPECT_EQ(warnings_of(R"({"type": "still", "at": 0.1}, {"type": "video", "to": 0.1})"), "");
}

// "last" is the end, wherever an instant is: a part that begins there is empty.
TEST(Films, APartThatBeginsAtTheEndIsRejected) {
    for (const char* output :
         {R"({"type": "video", "from": "last"})", R"({"type": "frames", "from": "last"})",
          R"({"type": "video", "from": "last", "speed": 0.1})", R"({"type": "video", "from": "last", "to": "last"})",
          R"({"type": "page", "from": "last"})", R"({"type": "video", "from": "last", "to": 0.05})"}) {
        const Reading reading = testing::read(R"({"time": {"end": 0.1}, "outputs": [)" + std::string(output) + "]}");
        EXPECT_FALSE(reading.scene.has_value()) << output;
        EXPECT_THAT(reading.report(), HasSubstr("0.1 s")) << output;
    }
    for (const std::string figure : {"kymograph", "strobe"})
        EXPECT_FALSE(
            testing::read(R"({"time": {"end": 0.1}, "outputs": [{"type": "figure", "from": "last", "figure": ")" +
                          figure + "\"}]}")
                .scene.has_value())
            << figure;
    const Reading after =
        testing::read(R"({"time": {"end": 0.1}, "outputs": [{"type": "video", "from": "last", "to": 0.2}]})");
    ASSERT_TRUE(after.scene.has_value());
    EXPECT_EQ(std::get<PictureOutput>(after.scene->outputs[0]).span.from, 0.1);
}

TEST(Films, ATimeAfterTheLatestPossibleEndIsRejected) {
    for (const char* output :
         {R"({"type": "still", "at": 1e100})", R"({"type": "figure", "figure": "strobe", "to": 1e100})",
          R"({"type": "figure", "figure": "kymograph", "to": 1e100})", R"({"type": "video", "from": 1e100})",
          R"({"type": "video", "to": 1e100})", R"({"type": "video", "poster": 1e100})",
          R"({"type": "figure", "figure": "kymograph", "from": 1e100})"}) {
        const Reading reading = testing::read(R"({"outputs": [)" + std::string(output) + "]}");
        EXPECT_FALSE(reading.scene.has_value());
        EXPECT_THAT(reading.report(), HasSubstr("= 1e+100 s is later than 1e+12 s; write the number of seconds"));
    }
}

// The default motion touches at 0.277 s (impact 1) and again from 0.768 s (collision 2).
TEST(Films, AShortenedFilmLeavesOutTheEventsThatItDoesNotReach) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 1}, "outputs": [{"type": "video", "file": "f.mp4", "size": [320, 180],
        "fps": 20, "poster": "impact:4", "view": {"style": "flat"},
        "events": [{"at": "impact:1", "freeze": 0.2}, {"at": "collision:2", "freeze": 0.4, "text": "again"}]}]})");
    const auto run = [&](const char* more) {
        const Finished finished = shell(folder, fmt::format("rm -f f.*; $BEAMCAM run s.json {}", more));
        EXPECT_EQ(finished.code, 0) << finished.err;
        return finished.err;
    };
    const std::string whole = run("");
    EXPECT_THAT(whole, ::testing::AllOf(HasSubstr("32 frames"), ::testing::Not(HasSubstr("warning"))));
    EXPECT_TRUE(std::filesystem::exists(folder / "f.png"));
    const std::string early = run("--set outputs.0.to=0.5");
    EXPECT_THAT(early, ::testing::AllOf(HasSubstr("14 frames"),
                                        HasSubstr("does not show collision 2 or impact 4, its poster")));
    EXPECT_FALSE(std::filesystem::exists(folder / "f.png"));
    const std::string late = run("--set outputs.0.from=0.5 --set outputs.0.to=1");
    EXPECT_THAT(late, ::testing::AllOf(HasSubstr("18 frames"), HasSubstr("does not show impact 1:")));
    const std::string compared =
        run(R"(--set outputs.0.to=0.5 --set 'outputs.0.compare=[{"label":"a"},{"label":"b","set":{"cam.speed":5}}]')");
    EXPECT_THAT(compared, HasSubstr("does not show collision 2 or impact 4, its poster"));
    // The whole motion without such an impact is a mistake.
    EXPECT_EQ(shell(folder, "$BEAMCAM run s.json --set 'outputs.0.events.0.at=\"impact:99\"'").code, 3);
}

TEST(Films, ScenesOfTheCommandLineAreCompared) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    folder.write("a.json", R"({"title": "slow", "cam": {"speed": 1}})");
    folder.write("b.json", R"({"title": "fast", "cam": {"speed": 5}})");
    const Finished finished = shell(folder,
                                    "$BEAMCAM render a.json b.json -o c.png --at 0.4 --style flat --size 640x360 && "
                                    "$BEAMCAM render a.json b.json -o c.png --at 0.4 --style flat -n");
    EXPECT_EQ(finished.code, 0) << finished.err;
    EXPECT_THAT(finished.out, HasSubstr("until 1.5 s, \"slow\""));
    EXPECT_THAT(finished.out, HasSubstr("until 1.5 s, \"fast\""));
}

// A grid of one mechanism would show the first motion alone.
TEST(Films, ALayoutForOneMotionGivesWayToTheStandardOne) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    folder.write("a.json", R"({"title": "slow", "outputs": [{"type": "video", "file": "a.mp4",
        "layout": {"columns": ["mechanism", "theta"]}}]})");
    folder.write("b.json", R"({"title": "fast", "cam": {"speed": 5}})");
    const std::string still = " --at 0.4 --style flat --size 640x360 && $BEAMCAM info --scene ";
    const Finished panels = shell(folder, "$BEAMCAM render a.json b.json -o c.png" + still + "c.png");
    EXPECT_EQ(panels.code, 0) << panels.err;
    EXPECT_THAT(panels.err, HasSubstr("does not show 2 motions"));
    EXPECT_THAT(panels.out, HasSubstr("\"layout\": \"auto\""));
    EXPECT_THAT(panels.out, HasSubstr("Two motions compared"));
    const Finished ghosts =
        shell(folder, "$BEAMCAM render a.json b.json -o d.png --comparison ghosts" + still + "d.png");
    EXPECT_THAT(ghosts.err, Not(HasSubstr("does not show")));
    EXPECT_THAT(ghosts.out, Not(HasSubstr("\"layout\": \"auto\"")));
}

TEST(Films, PicturesSayWhenTheBeamBendsBeyondItsModel) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    const std::string still =
        R"("outputs": [{"type": "still", "file": "s.png", "at": 0.4, "size": [640, 360], "view": {"style": "flat"}}]})";
    folder.write("soft.json", R"({"beam": {"youngs_modulus": 1e8, "damping_ratio": 0.05}, )" + still);
    folder.write("stiff.json", "{" + still);
    EXPECT_THAT(shell(folder, "$BEAMCAM run -q soft.json && $BEAMCAM info s.png").out,
                HasSubstr("bends beyond first-order"));
    EXPECT_THAT(shell(folder, "$BEAMCAM run -q stiff.json && $BEAMCAM info s.png").out, Not(HasSubstr("bends beyond")));
}

TEST(Films, AStripWithoutChannelsIsToldToNameThem) {
    const Reading reading =
        testing::read(R"({"outputs": [{"type": "video", "layout": {"rows": ["mechanism", "strip"]}}]})");
    EXPECT_FALSE(reading.scene);
    ASSERT_EQ(testing::messages(reading).size(), 1u);
    EXPECT_THAT(testing::messages(reading).front(), HasSubstr("needs channels"));
}

TEST(Films, KeysInAnotherObjectAreToldTheirPlace) {
    const auto place = [](const std::string& scene) { return testing::messages(testing::read(scene)).front(); };
    EXPECT_THAT(place(R"({"speed": {"around": "impacts"}})"),
                HasSubstr("its place is \"cam.speed\" or \"units.speed\" or \"outputs[].speed\""));
    EXPECT_THAT(place(R"({"friction": {"type": "none"}})"), HasSubstr("its place is \"contact.friction\""));
    EXPECT_THAT(place(R"({"beam": {"eccentricity": 1}})"), HasSubstr("its place is \"cam.eccentricity\""));
    EXPECT_THAT(place(R"({"beam": {"gravity": 1}})"), HasSubstr("its place is \"gravity\""));
    EXPECT_THAT(place(R"({"outputs": [{"type": "figure", "channels": ["theta"], "unit": "deg"}]})"),
                HasSubstr("its place is \"outputs[].panels[].unit\" or \"outputs[].table.unit\""));
    EXPECT_THAT(place(R"({"outputs": [{"type": "still", "at": 0, "style": "flat"}]})"),
                HasSubstr("its place is \"outputs[].view.style\""));
    EXPECT_THAT(place(R"({"layuot": 1})"), Not(HasSubstr("place")));
}

TEST(Films, AHubOverTheCamIsRefused) {
    const Reading over = testing::read(R"({"hub": {"radius": 0.3}})"),
                  beside = testing::read(R"({"hub": {"radius": 0.1}})");
    EXPECT_FALSE(over.scene);
    EXPECT_THAT(testing::messages(over).front(), HasSubstr("but the cam comes as near as"));
    EXPECT_TRUE(beside.scene);
}

TEST(Films, NeedTheEventsThatTheyNameAndTheImpactsAroundWhichTheySlowDown) {
    const auto needs = [](const std::string& keys) {
        const Reading reading = testing::read(R"({"outputs": [{"type": "video", )" + keys + "}]}");
        EXPECT_TRUE(reading.scene) << reading.report();
        return needs_events(reading.scene->outputs[0], *reading.scene);
    };
    EXPECT_FALSE(needs(R"("speed": 0.5)"));
    EXPECT_TRUE(needs(R"("speed": {"around": "impacts"})"));
    EXPECT_TRUE(needs(R"("poster": "impact:1")"));
    // What shows collisions one by one, as slow films do of themselves, has to know them.
    EXPECT_TRUE(needs(R"("speed": 0.3)"));
    EXPECT_TRUE(needs(R"("layout": {"panel": "contact_force", "window": "collision"})"));
    EXPECT_TRUE(needs(R"("speed": 0.3, "compare": [{"label": "a"}, {"label": "b", "set": {"cam.speed": 2}}])"));
}

TEST(Films, SlowDownAroundTheImpactsThatARunFinds) {
    const Reading reading = testing::read(R"({"outputs": [{"type": "video", "speed": {"around": "impacts"}}]})");
    ASSERT_TRUE(reading.scene);
    const Plan p = plan(resolve(*reading.scene, [](const sim::Problem&, const sim::Request&) {
        sim::Result result;
        result.impacts.resize(1);
        result.impacts[0].t_start = 0.3, result.impacts[0].t_end = 0.31;
        return result;
    }));
    EXPECT_GT(p.pictures.front().draw.size(), 90u + 60u);  // real time, and 22 ms at a fiftieth
}

// ---- posters -----------------------------------------------------------------------------------

constexpr const char* kWithPoster = R"({"time": {"end": 0.4}, "outputs": [
    {"type": "video", "file": "f.mkv", "size": [320, 180], "fps": 20, "view": {"style": "flat"}, "poster": "impact:1"}]})";

TEST(Posters, AreTheFilmsOwnFrame) {
    const Folder folder;
    folder.write("s.json", kWithPoster);
    const Finished made = shell(folder, "$BEAMCAM run s.json -v");
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_THAT(made.err, HasSubstr("f.png (poster)"));
    EXPECT_THAT(made.err, HasSubstr("frames_drawn=8 "));  // none of them twice
    // The touch is at 0.277 s: the first frame after it is number 6, and FFV1 keeps every bit of it.
    const std::string poster = shell(folder, "picture_hash f.png").out.substr(0, 64);
    EXPECT_THAT(shell(folder, "picture_hash f.mkv | sed -n 7p").out, HasSubstr(poster));
    EXPECT_THAT(shell(folder, "$BEAMCAM info f.png --scene").out, HasSubstr("\"poster\": \"impact:1\""));
}

TEST(Posters, BelongToWhatIsFinished) {
    const Folder folder;
    folder.write("s.json", kWithPoster);
    ASSERT_EQ(shell(folder, "$BEAMCAM run s.json").code, 0);
    EXPECT_THAT(shell(folder, "$BEAMCAM run s.json").err, HasSubstr("f.mkv: up to date"));
    EXPECT_THAT(shell(folder, "rm f.png && $BEAMCAM run s.json && ls").out, HasSubstr("f.png"));
    // A foreign picture of that name is refused before any work.
    const Finished refused = shell(folder, "rm f.* && echo mine > f.png && $BEAMCAM run s.json; ls");
    EXPECT_THAT(refused.err, HasSubstr("f.png"));
    EXPECT_THAT(refused.out, ::testing::Not(HasSubstr("f.mkv")));
}

TEST(Posters, OfAFilmThatWasShortenedAreItsLastFrame) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.4}, "outputs": [
        {"type": "video", "file": "f.mkv", "size": [160, 90], "fps": 20, "view": {"style": "flat"}, "poster": 0.3}]})");
    ASSERT_EQ(shell(folder, "$BEAMCAM run s.json -q --set time.end=0.2").code, 0);
    const std::string poster = shell(folder, "picture_hash f.png").out.substr(0, 64);
    EXPECT_THAT(shell(folder, "picture_hash f.mkv | tail -n 1").out, HasSubstr(poster));
}

// Nothing of it stands in the picture, as was asked for: then it is told.
TEST(Films, WithoutALegendTheExaggerationIsToldOnTheCommandLine) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.4}})");
    const std::string still = "$BEAMCAM render s.json --at 0.3 --size 320x180 --style flat --force -o s.png";
    EXPECT_THAT(shell(folder, still + " --show clean").err, HasSubstr("without stating it; state it in the caption"));
    EXPECT_THAT(shell(folder, still).err, Not(HasSubstr("without stating it")));
    EXPECT_THAT(shell(folder, still + " --show clean --set beam.model=rigid").err,
                Not(HasSubstr("without stating it")));
}

TEST(Render, RejectsOptionsThatWouldDoNothing) {
    const Folder folder;
    folder.write("s.json", "{}");
    for (const auto& [arguments, words] : std::initializer_list<std::pair<const char*, const char*>>{
             {"--at 0.3 -o a.png --fps 10",
              "--fps: unknown key \"fps\" in the output; it goes with type=video | type=frames"},
             {"--at 0.3 -o a.png --duration '4 s'", "it goes with type=video | type=frames"},
             {"--at 0.3 -o a.pdf --poster 0.1",
              "--poster: unknown key \"poster\" in the output; it goes with type=video"},
             {"-o a-##.png --poster 0.1", "it goes with type=video"}}) {
        const Finished done = shell(folder, std::string("$BEAMCAM render s.json ") + arguments);
        EXPECT_EQ(done.code, 2) << arguments;
        EXPECT_THAT(done.err, HasSubstr(words)) << arguments;
    }
}

TEST(Posters, AreAskedForAndRefusedInWords) {
    const Folder folder;
    folder.write("s.json", kWithPoster);
    EXPECT_EQ(shell(folder, "$BEAMCAM render s.json -o g.mkv --to 0.1 -q && ls *.png").out, "");  // only when asked
    EXPECT_EQ(shell(folder, "$BEAMCAM render s.json -o g.mkv --to 0.1 --poster '50 ms' -q && ls *.png").out, "g.png\n");
    EXPECT_EQ(shell(folder, "$BEAMCAM render s.json -o h-##.png --poster 0.1").code, 2);
    EXPECT_EQ(shell(folder, "$BEAMCAM render s.json -o h.mkv --poster impact:9").code, 3);
    const Reading clash = testing::read(R"({"outputs": [{"type": "video", "file": "a.mp4", "poster": 0.1},
        {"type": "still", "file": "a.png", "at": 0.2}]})");
    EXPECT_FALSE(clash.scene);
    EXPECT_THAT(clash.report(), HasSubstr("would write the same file \"a.png\""));
}

// A film that ends before the scene's other pictures tells of itself as if the run had ended with it.
TEST(Films, EndBeforeStillsOfImpactsAndOfLaterInstants) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    for (const char* at : {"\"impact:1\"", "1.2"}) {
        folder.write(
            "s.json",
            std::string(
                R"({"outputs": [{"type": "still", "file": "t.png", "size": [160, 90], "view": {"style": "flat"}, "at": )") +
                at +
                R"(}, {"type": "video", "file": "f.mkv", "to": 0.3, "fps": 10, "size": [160, 90], "view": {"style": "flat"}}]})");
        EXPECT_EQ(shell(folder, "$BEAMCAM run s.json --force").code, 0) << at;
        EXPECT_EQ(shell(folder, "picture_hash f.mkv").out.size(),
                  shell(folder, "picture_hash f.mkv | head -n 3").out.size());
    }
}

// ---- what scales are chosen by ---------------------------------------------------------------

TEST(Films, ScalesComeFromTheSameInstantsAtAnyFrameRate) {
    const auto surveyed = [](const std::string& output) {
        const Reading reading = testing::read(R"({"time": {"end": 1}, "outputs": [)" + output + "]}");
        return resolve(*reading.scene, {}).outputs.front().times.survey;
    };
    const auto thirty = surveyed(R"({"type": "video", "fps": 30, "from": 0.2, "to": 0.4})"),
               sixty = surveyed(R"({"type": "video", "fps": 60, "from": 0.2, "to": 0.4})");
    EXPECT_EQ(thirty, sixty);
    EXPECT_EQ(thirty.front(), 0.2);
    EXPECT_EQ(thirty.back(), 0.4);
    EXPECT_EQ(surveyed(R"({"type": "still", "at": 0.3})").back(), 1);
}

// A picture of an impact has the factor of the film: "deflection ×5", not what the beam's bend in free fall would bear.
TEST(Films, AStillOfAnImpactIsExaggeratedAsTheFilmIs) {
    const Reading reading = testing::read(R"({"time": {"end": 1}, "outputs": [{"type": "still", "at": "impact:1"},
        {"type": "video", "fps": 30}]})");
    const ResolvedScene resolved = resolve(
        *reading.scene,
        [](const sim::Problem& problem, const sim::Request& request) { return sim::simulate(problem, request); });
    const auto survey = [&](std::size_t i) { return resolved.outputs[i].times.survey; };
    EXPECT_EQ(survey(0), survey(1));
}

// ---- how long films last, and what goes with them --------------------------------------------

FilmTimes times_in(const std::string& keys, const sim::Result& motion = {}) {
    const Reading reading =
        testing::read(R"({"time": {"end": 1}, "outputs": [{"type": "video", "fps": 30, )" + keys + "}]}");
    EXPECT_TRUE(reading.scene) << reading.report();
    return film_times(std::get<PictureOutput>(reading.scene->outputs[0]).span, 1, motion, motion.impacts);
}

TEST(Films, LastAsLongAsIsWanted) {
    const FilmTimes slow = times_in(R"("duration": "10 s")");
    EXPECT_EQ(slow.frames.size(), 300u);
    EXPECT_NEAR(slow.frames.back(), 1 - 1.0 / 300, 1e-12);
    const FilmTimes frozen = times_in(R"("duration": "10 s", "hold": 2, "events": [{"at": 0.5, "freeze": 3}])");
    EXPECT_EQ(frozen.frames.size(), 300u);
    EXPECT_NEAR(frozen.speeds.front(), 1.0 / 5, 1e-12);
    EXPECT_THROW(times_in(R"("duration": 1, "events": [{"at": "last", "freeze": 2}])"), std::runtime_error);
}

TEST(Films, ShowWordsForTheirTimeUntilTheNext) {
    const FilmTimes told = times_in(R"("events": [{"at": 0.1, "text": "a"}, {"at": 0.2, "text": "b", "show": 0.5},
        {"at": 0.3, "text": "c", "show": 0.2}])");
    ASSERT_EQ(told.callouts.size(), 3u);
    EXPECT_EQ(told.callouts[0].last, 5);
    EXPECT_EQ(told.callouts[1].last, 8);
    EXPECT_EQ(told.callouts[2].first, 9);
    EXPECT_EQ(told.callouts[2].last, 15);
}

TEST(Films, HoldTheirLastPictureAtTheVeryEnd) {
    const FilmTimes held = times_in(R"("hold": 0.5, "poster": "last")");
    ASSERT_EQ(held.frames.size(), 45u);
    for (std::size_t k = 30; k < 45; ++k) EXPECT_EQ(held.frames[k], 1);
    EXPECT_EQ(held.speeds[29], 1);
    EXPECT_EQ(held.speeds.back(), 0);  // the picture says that it is frozen
    EXPECT_EQ(held.poster, 37);        // the middle one of them
    EXPECT_EQ(times_in(R"("poster": "last")").poster, 29);
}

TEST(Films, OfFewFramesSuggestADuration) {
    const Folder folder;
    folder.write("s.json",
                 R"({"time": {"end": "20 ms"}, "outputs": [{"type": "video", "file": "f.mkv", "size": [96, 96],
        "view": {"style": "flat"}}]})");
    EXPECT_THAT(shell(folder, "$BEAMCAM run s.json").err, HasSubstr("\"duration\": \"4 s\" (speed 0.005)"));
}

TEST(Films, CutShortTellOfCollisionsThatDoNotCome) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.5}, "outputs": [{"type": "video", "file": "f.mkv", "size": [96, 96],
        "to": 0.4, "view": {"style": "flat"}, "speed": {"around": "impacts", "factor": 0.5, "collisions": [1, 9]}}]})");
    const std::string told = shell(folder, "$BEAMCAM run s.json").err;
    EXPECT_THAT(told, HasSubstr("f.mkv does not show the slow motion of collision 9: outside the film"));
    EXPECT_THAT(told, Not(HasSubstr("collision 1")));
}

// ---- what can come to nothing ----------------------------------------------------------------

TEST(Films, TellOfSpeedsAndKeyframesOutOfPlace) {
    const auto told = [](const std::string& keys) {
        const Reading reading = testing::read(R"({"time": {"end": 1}, "outputs": [{"type": "video", )" + keys + "}]}");
        return std::pair{reading.scene.has_value(), reading.report()};
    };
    const auto late = told(R"("speed": {"around": "intervals", "intervals": [{"from": 0.5, "to": 2}]})");
    EXPECT_TRUE(late.first);
    EXPECT_THAT(late.second, HasSubstr("outputs.0.speed.intervals.0.to = 2 s is outside the film from 0 s to 1 s"));
    const auto mixed =
        told(R"("speed": {"around": "intervals", "intervals": [{"from": 0.5, "to": 0.7}, {"from": 0.1, "to": 0.2}]})");
    EXPECT_FALSE(mixed.first);
    EXPECT_THAT(mixed.second,
                HasSubstr("outputs.0.speed.intervals.1.from = 0.1 s is before the end of the previous interval"));
    EXPECT_TRUE(
        told(R"("speed": {"around": "intervals", "intervals": [{"from": 0.5, "to": 0.7}, {"from": 0.7, "to": 0.8}]})")
            .second.empty());
    EXPECT_THAT(told(R"("speed": {"around": "impacts", "collisions": [1.5]})").second,
                HasSubstr("outputs.0.speed.collisions.0 = 1.5 must be a whole number"));
    const auto beyond = told(R"("view": {"camera": {"keyframes": [{"at": 3}]}})");
    EXPECT_TRUE(beyond.first);
    EXPECT_THAT(beyond.second, HasSubstr("view.camera.keyframes.0.at = 3 s is outside the film"));
    const auto keyframes = told(R"("view": {"camera": {"keyframes": [{"at": 0.5}, {"at": 0.2}, {"at": "impact:1"}]}})");
    EXPECT_FALSE(keyframes.first);
    EXPECT_THAT(keyframes.second, HasSubstr("view.camera.keyframes.1.at = 0.2 s is not after the previous keyframe"));
}

// Events out of order are known only when the motion is.
TEST(Films, RefuseKeyframesAtEventsOutOfOrder) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 1}, "outputs": [{"type": "video", "file": "f.mkv", "size": [96, 96],
        "view": {"style": "flat", "camera": {"keyframes": [{"at": "impact:2", "zoom": 2}, {"at": "impact:1"}]}}}]})");
    const Finished run = shell(folder, "$BEAMCAM run s.json");
    EXPECT_EQ(run.code, 3);
    EXPECT_THAT(run.err, HasSubstr("s.json:1:34: f.mkv: the camera's keyframe at impact 1, 0.277"));
    EXPECT_THAT(run.err, HasSubstr("is not after the previous one"));
}

TEST(Films, TellOfCamerasThatLookPast) {
    const Folder folder;
    folder.write("s.json",
                 R"({"time": {"end": 0.5}, "outputs": [{"type": "video", "file": "f.mkv", "size": [96, 96], "fps": 20,
        "view": {"style": "flat", "camera": {"follow": [50, 50], "keyframes": [{"at": 0.2, "follow": "tip", "over": 0}]}}}]})");
    const std::string told = shell(folder, "$BEAMCAM run s.json").err;
    EXPECT_THAT(told, HasSubstr("the mechanism is outside the picture in 4 of"));
}

TEST(Films, TellOfWhatTheyWillNotShow) {
    const auto told = [](const std::string& output, const std::string& physics = {}) {
        const Reading reading = testing::read("{" + physics + "\"time\": {\"end\": 1}, \"outputs\": [" + output + "]}");
        return std::pair{reading.scene.has_value(), reading.report()};
    };
    const auto late = told(R"({"type": "video", "to": 0.3, "events": [{"at": 0.5, "text": "late"}]})");
    EXPECT_TRUE(late.first);
    EXPECT_THAT(late.second, HasSubstr("outputs.0.events.0.at = 0.5 s is outside the film from 0 s to 0.3 s"));
    const auto camera = told(R"({"type": "video", "view": {"camera": {"keyframes": [{"at": 5, "zoom": 2}]}}})");
    EXPECT_THAT(camera.second, HasSubstr("outputs.0.view.camera.keyframes.0.at = 5 s is outside the film"));
    const auto slow = told(R"({"type": "video", "speed": {"around": "intervals",
        "intervals": [{"from": 0.5, "to": 4, "factor": 0.5}]}})");
    EXPECT_THAT(slow.second, HasSubstr("outputs.0.speed.intervals.0.to = 4 s is outside the film"));
    const auto nowhere = told(R"({"type": "video", "events": [{"at": 0.2, "text": "C", "anchor": "cam"}]})");
    EXPECT_FALSE(nowhere.first);
    EXPECT_THAT(nowhere.second, HasSubstr("it was withdrawn: texts are in a band below the panels"));
    const auto alone = told(R"({"type": "still", "at": 0.1, "comparison": "ghosts"})");
    EXPECT_TRUE(alone.first);
    EXPECT_THAT(alone.second, HasSubstr("has no effect without \"compare\""));
    const auto flat = told(R"({"type": "still", "at": 0.1, "view": {"style": "flat", "camera": {"yaw": 0.5}}})");
    EXPECT_TRUE(flat.first);
    EXPECT_THAT(flat.second, HasSubstr("outputs.0.view.camera.yaw has an effect in the solid view only"));
    const auto followed =
        told(R"({"type": "still", "at": 0.1, "view": {"camera": {"keyframes": [{"at": 0.1, "follow": "contact"}]}}})",
             R"("cam": null, )");
    EXPECT_FALSE(followed.first);
    EXPECT_THAT(followed.second, HasSubstr("the scene has no cam to follow"));
    const auto formula = told(R"({"type": "video", "events": [{"at": 0.5, "text": "$\\nonsense$"}]})");
    EXPECT_TRUE(formula.first);
    EXPECT_THAT(formula.second, HasSubstr("\\nonsense is not among the commands"));
    const std::string two = R"("compare": [{"label": "a"}, {"label": "b", "set": {"cam": null}}])";
    const auto collisions =
        told(R"({"type": "video", "layout": {"panel": "contact_force", "window": "collision"}, )" + two + "}");
    EXPECT_FALSE(collisions.first);
    EXPECT_THAT(collisions.second, HasSubstr("needs one motion, but the picture compares 2"));
    EXPECT_TRUE(told(R"({"type": "video", "layout": {"rows": ["mechanism", "contact_force"]}, )" + two + "}").first);
    EXPECT_FALSE(
        told(R"({"type": "video", "layout": {"rows": ["mechanism", {"panel": "close-up", "motion": 2}]}, )" + two + "}")
            .first);
}

TEST(Films, AFirstMotionWithoutACamHidesNoContactOfTheOthers) {
    const Reading reading = testing::read(R"({"time": {"end": 1}, "outputs": [{"type": "still", "at": 0.5,
        "compare": [{"label": "free", "set": {"cam": null}}, {"label": "cam"}]}]})");
    const Plan made = plan(resolve(*reading.scene, {}));
    EXPECT_THAT(made.motions.front().request.tables.at(kChartTable).channels,
                ::testing::Contains(sim::Channel{sim::ChannelKind::contact_force, 0}));
}

TEST(Films, AFactorThatYieldsIsTold) {
    const Folder folder;
    folder.write("s.json",
                 R"({"time": {"end": 1}, "outputs": [{"type": "still", "file": "a.png", "at": 0.7, "size": [160, 90],
        "view": {"style": "flat", "exaggeration": 1e6}}]})");
    EXPECT_THAT(shell(folder, "$BEAMCAM run s.json").err,
                HasSubstr("instead of ×1e+06, which would draw the beam inside the cam"));
    EXPECT_THAT(shell(folder, "$BEAMCAM run s.json --force --set outputs.0.view.exaggeration=2").err,
                ::testing::Not(HasSubstr("warning")));
}

TEST(Films, ATitleThatDoesNotFitIsTold) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.1}, "outputs": [{"type": "still", "file": "a.png", "at": 0.1,
        "size": [320, 180], "view": {"style": "flat"}}]})");
    const std::string run = "$BEAMCAM run s.json --force --set 'title=";
    const std::string words = "a beam of aluminium falls on a cam ";  // 35 letters
    EXPECT_THAT(shell(folder, run + words + words + "'").err, ::testing::Not(HasSubstr("title")));
    EXPECT_THAT(shell(folder, run + words + words + words + words + "'").err,
                HasSubstr("warning: a.png shows only the beginning of the title: 320 × 180"));
}

// ---- colours of a GIF --------------------------------------------------------------------------

// Against palettegen's colours without dither, the best that ffmpeg makes of the same frames.
TEST(Films, GifsAreAsTrueAsThoseOfPalettegenAndNoLarger) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    folder.write("s.json", R"({"title": "Fall", "time": {"end": 1}, "outputs": [
        {"type": "video", "file": "a.gif", "size": [640, 360], "fps": 20, "view": {"style": "flat"}},
        {"type": "frames", "file": "f-##.png", "size": [640, 360], "fps": 20, "view": {"style": "flat"}}]})");
    ASSERT_EQ(shell(folder, "$BEAMCAM run s.json").code, 0);
    ASSERT_EQ(shell(folder,
                    "ffmpeg -v error -framerate 20 -i f-%02d.png -vf "
                    "'split[x][y];[x]palettegen[p];[y][p]paletteuse=dither=none' b.gif")
                  .code,
              0);
    const auto decibels = [&](const std::string& gif) {
        const Finished told = shell(folder, "ffmpeg -i " + gif +
                                                " -framerate 20 -i f-%02d.png -lavfi "
                                                "'[0]format=rgb24[m];[1]format=rgb24[n];[m][n]psnr' -f null - 2>&1");
        const std::size_t at = told.out.find("average:");
        EXPECT_NE(at, std::string::npos) << told.out;
        return at == std::string::npos ? 0 : std::stod(told.out.substr(at + 8));
    };
    EXPECT_GT(decibels("a.gif"), decibels("b.gif"));
    EXPECT_LE(std::filesystem::file_size(folder.path() / "a.gif"), std::filesystem::file_size(folder.path() / "b.gif"));
}

TEST(Films, CharactersThatNoFontHasAreTold) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    folder.write("s.json",
                 R"({"title": "Fall 🙂", "time": {"end": 0.4}, "outputs": [{"type": "frames", "file": "a-##.png",
        "size": [64, 48], "fps": 10, "view": {"style": "flat", "camera": {"keyframes": [{"at": "impact:1", "zoom": 4}]}}}]})");
    const Finished run = shell(folder, "$BEAMCAM run s.json");
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("omits 🙂: no font has these characters"));
    EXPECT_THAT(shell(folder, "$BEAMCAM check s.json").err, HasSubstr("omits 🙂: no font has these characters"));
    EXPECT_EQ(shell(folder, "$BEAMCAM check s.json --set title=Fall").err, "s.json: fine\n");
}

// ---- what finds no room ------------------------------------------------------------------------

TEST(Films, PanelsThatFindNoRoomAreTold) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.1}, "outputs": [{"type": "still", "file": "a.png", "at": 0.1,
        "size": [640, 300], "view": {"style": "flat"},
        "layout": {"columns": ["mechanism", {"rows": ["theta", "contact_force", "energy"]}]}}]})");
    EXPECT_THAT(shell(folder, "$BEAMCAM run s.json").err, HasSubstr("warning: a.png shows no energy: 640 × 300"));
    EXPECT_THAT(shell(folder, "$BEAMCAM run s.json -q --force").err, ::testing::IsEmpty());
    // The standard arrangement is nobody's wish.
    EXPECT_THAT(shell(folder, "$BEAMCAM run s.json --force --set outputs.0.layout=auto").err,
                ::testing::Not(HasSubstr("warning")));
}

}  // namespace
}  // namespace beamcam::scenes
