#include "scenes/plan/story.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "render/base/error.hpp"
#include "sim/run/simulate.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::HasSubstr;
using testing::read;

// The film of a scene with this story, after its events are known.
ResolvedOutput film_of(const std::string& mechanics, const std::string& story, const std::string& keys = "") {
    const Reading reading = read("{" + mechanics + R"("outputs": [{"type": "video", "file": "a.mp4", "story": ")" +
                                 story + "\"" + keys + "}]}");
    EXPECT_TRUE(reading.scene) << reading.report();
    return resolve(*reading.scene, [](const sim::Problem& problem,
                                      const sim::Request& request) { return sim::simulate(problem, request); })
        .outputs.at(0);
}

sim::Result motion_of(const std::string& mechanics, double end) {
    sim::Request request;
    request.end_time = end;
    return sim::simulate(read("{" + mechanics + R"("outputs": []})").scene->problem, request);
}

std::vector<std::string> texts(const ResolvedOutput& film) {
    std::vector<std::string> all;
    for (const render::Callout& each : film.times.callouts) all.push_back(each.text);
    return all;
}

double shown_at(const ResolvedOutput& film, const std::string& text) {
    for (const render::Callout& each : film.times.callouts)
        if (each.text.find(text) != std::string::npos) return film.times.frames.at(std::size_t(each.first));
    ADD_FAILURE() << "no caption with " << text;
    return -1;
}

const std::string kFlexible = R"("beam": {"modes": 4}, "time": {"end": 1}, )";
// A rod that falls on a cam at rest, with a coefficient of restitution of one half.
const std::string kRigid = R"("beam": {"model": "rigid"}, "cam": {"speed": 0}, "time": {"end": 3}, )"
                           R"("contact": {"model": "restitution", "restitution": 0.5}, )";

TEST(Story, ImpactTellsTheEventsOfTheFirstCollision) {
    const ResolvedOutput film = film_of(kFlexible, "impact");
    const sim::Collision c = motion_of(kFlexible, 1).collisions.at(0);
    const auto near = [](double t) { return ::testing::DoubleNear(t, 1e-3); };
    EXPECT_THAT(shown_at(film, "touches 250"), near(c.t_start));
    EXPECT_THAT(shown_at(film, "with 4 modes, "), near(*c.t_peak));  // which change the force
    EXPECT_THAT(shown_at(film, "the collision ends after"), near(*c.t_end));
    EXPECT_THAT(shown_at(film, "rebound"), near(film.end_time));
    EXPECT_GT(film.end_time, *c.t_end);
    EXPECT_LT(film.end_time, motion_of(kFlexible, 1).collisions.at(1).t_start);
    const double seconds = double(film.times.frames.size()) / 60;
    EXPECT_GT(seconds, 8);
    EXPECT_LT(seconds, 20);
    EXPECT_EQ(film.times.moves.size(), 2u);
    EXPECT_EQ(*std::ranges::min_element(film.times.speeds), 0);  // it freezes
}

// Newton's impact law leaves e² = 25 % of the kinetic energy, which becomes height.
TEST(Story, ImpactTellsWhatBecameOfTheEnergy) {
    EXPECT_THAT(texts(film_of(kRigid, "impact")).back(), HasSubstr("at the touch: 25\u00A0% rebound, 75\u00A0% lost"));
}

// Shares are those of the sum that the text begins with.
TEST(Story, ImpactTellsTheSumOfTheEnergies) {
    const std::string fast = R"("beam": {"model": "rigid"}, "cam": {"speed": 30, "phase": 1}, "time": {"end": 2}, )";
    EXPECT_THAT(
        texts(film_of(fast, "impact")).back(),
        ::testing::ContainsRegex("^energy [0-9.]+.+J \\([0-9.]+.+J at the touch, [0-9.]+.+J from the cam\\): "));
}

TEST(Story, ImpactTellsTheFirstCollisionAfterItsBeginning) {
    const double second = motion_of(kFlexible, 1).collisions.at(1).t_start;
    EXPECT_NEAR(shown_at(film_of(kFlexible, "impact", R"(, "from": "apex:1")"), "touches"), second, 1e-3);
}

// It begins before the touch that "from" names, and ends where a contact that lasts has been shown.
TEST(Story, ImpactTellsTheCollisionThatItsBeginningNames) {
    const sim::Result motion = motion_of(kFlexible, 1);
    const ResolvedOutput film = film_of(kFlexible, "impact", R"(, "from": "collision:2")");
    EXPECT_NEAR(shown_at(film, "touches"), motion.collisions.at(1).t_start, 1e-3);
    EXPECT_LT(film.times.frames.front(), motion.collisions.at(1).t_start - 0.1);
}

TEST(Story, ImpactShowsAContactThatLastsForAWhile) {
    const std::string pressed =
        R"("beam": {"model": "rigid"}, "cam": {"speed": 0}, "contact": {"restitution": 0.05}, "time": {"end": 3}, )"
        R"("hub": {"drive": {"type": "torque", "value": -5}}, )";
    const std::vector<sim::Collision> all = motion_of(pressed, 3).collisions;
    ASSERT_FALSE(all.back().t_end);
    const ResolvedOutput film = film_of(pressed, "impact", fmt::format(R"(, "from": "collision:{}")", all.size()));
    EXPECT_THAT(texts(film), ::testing::Contains("stays in contact"));
    EXPECT_LT(double(film.times.frames.size()) / 60, 30);
}

TEST(Story, ImpactDoesNotSayThatABeamStaysWhichBouncesOn) {
    const std::string relay = R"("contact": {"collision_gap": 10}, "time": {"end": 1}, )";
    EXPECT_THAT(texts(film_of(relay, "impact", "")), ::testing::Not(::testing::Contains("stays in contact")));
}

TEST(Story, SettleEndsWithAContactThatLasts) {
    const ResolvedOutput film = film_of(kRigid, "settle");
    const double settled = motion_of(kRigid, 3).impacts.back().t_start;
    EXPECT_NEAR(shown_at(film, "stays in contact"), settled, 0.05);
    EXPECT_LT(shown_at(film, "infinitely many impacts until "), settled);
    EXPECT_GE(film.end_time, settled);
}

TEST(Story, SpeaksTheLanguageOfThePicture) {
    for (const std::string& text : texts(film_of(kFlexible, "impact", R"(, "lang": "zh")"))) {
        for (const char* word : {"touch", "rebound", "lost", "cam", "after", "impact", "gravity"})
            EXPECT_EQ(text.find(word), std::string::npos) << text;
    }
}

std::string reason(const std::string& mechanics, const std::string& story) {
    try {
        film_of(mechanics, story);
    } catch (const render::PictureError& error) {
        return error.what();
    }
    return "";
}

TEST(Story, SaysWhereThereIsNone) {
    EXPECT_THAT(reason(R"("time": {"end": 0.2}, )", "impact"), HasSubstr("needs a collision, but the motion has none"));
    EXPECT_THAT(read(R"({"cam": null, "outputs": [{"type": "video", "file": "a.mp4", "story": "impact"}]})").report(),
                HasSubstr("the scene has no cam"));
    EXPECT_THAT(reason(kFlexible, "settle"), HasSubstr("needs a contact that lasts"));
}

TEST(Story, ExcludesWhatItMakes) {
    for (const char* key : {R"("speed": 0.5)", R"("duration": 3)", R"("to": 0.4)", R"("events": [{"at": 0.1}])",
                            R"("hold": 1)", R"("compare": [{"label": "a"}, {"label": "b"}])"}) {
        const Reading reading =
            read(std::string(R"({"outputs": [{"type": "video", "file": "a.mp4", "story": "impact", )") + key + "}]}");
        EXPECT_FALSE(reading.scene) << key;
        EXPECT_THAT(reading.report(), HasSubstr("story")) << key;
    }
}

}  // namespace
}  // namespace beamcam::scenes
