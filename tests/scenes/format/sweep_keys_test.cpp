// The key "sweep": what it means, what is wrong with it, that it comes back as it was written.
#include "scenes/format/sweep_keys.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::ElementsAre, ::testing::HasSubstr;
using testing::messages, testing::read;

std::string scene_with(const std::string& sweep) { return "{\"sweep\": " + sweep + "}"; }
constexpr const char* kSpeed = R"({"key": "cam.speed", "from": 40, "to": 52, "count": 601})";

TEST(SweepKeys, AreReadWrittenAndReadAgain) {
    for (const std::string& text :
         {std::string(R"({"over": [)") + kSpeed + "]}",
          std::string(R"({"over": [)") + kSpeed + R"(, {"key": "contact.restitution", "values": [0.3, 0.5]}],
              "sample": "apexes", "transient": {"cam_turns": 500}, "keep": {"time": "2 s"},
              "seed": ["carry-up", "carry-down"]})",
          std::string(R"({"over": [{"key": "cam.speed", "from": 1, "to": 100, "count": 3, "spacing": "log"}],
              "sample": {"section": "theta_dot", "at": 0.5, "direction": "falling"},
              "seed": {"random": 8, "key": [{"key": "initial.angle", "from": 0.5, "to": 1}]}})")}) {
        const Reading reading = read(scene_with(text));
        ASSERT_TRUE(reading.scene && reading.scene->sweep) << reading.report();
        const Reading again = read(to_json(*reading.scene));
        ASSERT_TRUE(again.scene) << again.report();
        EXPECT_EQ(*again.scene->sweep, *reading.scene->sweep) << text;
    }
}

TEST(SweepKeys, MeanWhatTheySay) {
    const Sweep sweep = *read(scene_with(std::string(R"({"over": [)") + kSpeed + R"(],
        "sample": {"section": "cam_angle", "at": 1}, "transient": {"time": 3}, "seed": {"random": 4}})"))
                             .scene->sweep;
    EXPECT_EQ(sweep.sampling.kind, sim::SampleKind::section);
    EXPECT_EQ(sweep.sampling.level, 1);
    EXPECT_EQ(sweep.sampling.transient.time, 3);
    EXPECT_EQ(sweep.sampling.keep.turns, 50);
    EXPECT_THAT(sweep.seeds.kinds, ElementsAre(SeedKind::random));
    EXPECT_EQ(sweep.seeds.random, 4);
    EXPECT_FALSE(read("{}").scene->sweep);
    // As after --seed.
    const auto seeds = [](const char* text) {
        const Reading reading = read(scene_with(fmt::format(R"({{"over": [{}], "seed": "{}"}})", kSpeed, text)));
        return reading.scene ? reading.scene->sweep->seeds : SweepSeeds{};
    };
    EXPECT_EQ(seeds("random:4"), sweep.seeds);
    EXPECT_THAT(seeds("carry-up,carry-down").kinds, ElementsAre(SeedKind::carry_up, SeedKind::carry_down));
    EXPECT_THAT(read(scene_with(fmt::format(R"({{"over": [{}], "seed": "random:0"}})", kSpeed))).report(),
                HasSubstr("sweep.seed.random = 0 is outside 1"));
    const Sweep units =
        *read(scene_with(R"({"over": [{"key": "initial.angle", "from": "30°", "to": "90 deg", "count": 4},
        {"key": "cam.speed", "values": ["60 rpm", 7]}],
        "seed": {"random": 2, "key": [{"key": "initial.angular_velocity", "from": "-60 rpm", "to": 1}]}})"))
             .scene->sweep;
    EXPECT_NEAR(*units.over[0].from, std::numbers::pi / 6, 1e-15);
    EXPECT_NEAR(*units.over[0].to, std::numbers::pi / 2, 1e-15);
    EXPECT_NEAR(units.over[1].values.at(0), 2 * std::numbers::pi, 1e-14);
    EXPECT_EQ(units.over[1].values.at(1), 7);
    EXPECT_NEAR(units.seeds.keys.at(0).from, -2 * std::numbers::pi, 1e-14);
    EXPECT_FALSE(read(scene_with("null")).scene->sweep);
}

TEST(SweepKeys, AreRejectedWithTheRemedy) {
    const auto only = [](const std::string& sweep) {
        const std::vector<std::string> all = messages(read(scene_with(sweep)));
        return all.size() == 1 ? all.front() : "messages: " + std::to_string(all.size());
    };
    EXPECT_THAT(only(R"({"over": [{"key": "cam.spee", "from": 1, "to": 2, "count": 3}]})"),
                HasSubstr("did you mean \"cam.speed\"?"));
    EXPECT_THAT(only(R"({"over": [{"key": "cam.speed", "from": 1}]})"), HasSubstr("write from, to and count"));
    EXPECT_THAT(only(R"({"over": [{"key": "cam.speed", "values": ["3 mm"]}]})"), HasSubstr("rad/s"));
    EXPECT_THAT(only(R"({"over": [{"key": "cam.speed", "from": 1, "to": 2, "count": 1}]})"), HasSubstr("one value"));
    EXPECT_THAT(only(R"({"over": [{"key": "cam.speed", "from": 2, "to": 2, "count": 3}]})"), HasSubstr("equal values"));
    EXPECT_THAT(only(R"({"over": [{"key": "cam.speed", "values": [50, 40, 50]}]})"), HasSubstr("values: equal"));
    EXPECT_THAT(only(R"({"over": [{"key": "cam.speed", "from": -1, "to": 2, "count": 4, "spacing": "log"}]})"),
                HasSubstr("one sign"));
    EXPECT_THAT(only(std::string(R"({"over": [)") + kSpeed + "," + kSpeed + "]}"), HasSubstr("listed twice"));
    EXPECT_THAT(only(std::string(R"({"over": [)") + kSpeed + R"(], "seed": {"random": 2,
                     "key": [{"key": "initial.angle", "from": 0.6, "to": 0.5}]}})"),
                HasSubstr("exchange them"));
    EXPECT_THAT(only(std::string(R"({"over": [)") + kSpeed + R"(], "seed": "random"})"), HasSubstr("carry-up"));
    EXPECT_THAT(only(std::string(R"({"over": [)") + kSpeed + R"(], "sample": {"section": "thet", "at": 0}})"),
                HasSubstr("did you mean \"theta\"?"));
    EXPECT_THAT(messages(read(R"({"cam": null, "sweep": {"over": [{"key": "gravity", "values": [1, 2]}]}})")),
                ElementsAre(HasSubstr("there is no cam")));
}

// As after the options of `beamcam sweep`.
TEST(SweepKeys, HaveAbbreviations) {
    const auto with = [](const char* key, const char* text) {
        Scene scene;
        Node keys = object_node(
            {{"over", array_node({object_node({{"key", "gravity"}, {"values", Node(std::vector{9.0})}})})}});
        add(keys, key, text);
        const std::string problem = read_sweep(keys, scene);
        return std::pair(problem, scene.sweep.value_or(Sweep{}));
    };
    const auto sample = [&](const char* text) { return with("sample", text).second.sampling; };
    EXPECT_EQ(sample("apexes").kind, sim::SampleKind::apexes);
    EXPECT_EQ(sample("section:cam_angle=0").kind, sim::SampleKind::section);
    EXPECT_EQ(sample("section:theta_dot=0.5:falling").kind, sim::SampleKind::crossings);
    EXPECT_EQ(sample("section:theta_dot=0.5:falling").level, 0.5);
    EXPECT_FALSE(sample("section:theta_dot=0.5:falling").rising);
    EXPECT_THAT(with("sample", "section:thet=0").first, HasSubstr("\"theta\""));
    EXPECT_NEAR(sample("section:theta=90deg").level, std::numbers::pi / 2, 1e-15);
    EXPECT_THAT(with("sample", "section:theta=3 m").first, HasSubstr("measured in rad"));
    EXPECT_THAT(with("sample", "section:contact_force=10 m").first, HasSubstr("measured in N"));
    EXPECT_THAT(with("sample", "section:theta=0:sinking").first, HasSubstr("direction"));
    EXPECT_NE(with("sample", "every-day").first, "");
    EXPECT_THAT(with("seed", "carry-up,carry-down").second.seeds.kinds,
                ElementsAre(SeedKind::carry_up, SeedKind::carry_down));
    EXPECT_EQ(with("seed", "random:8").second.seeds.random, 8);
    for (const char* text : {"", "random", "random:0", "random:x", "up", "same,", "same,same"})
        EXPECT_NE(with("seed", text).first, "") << text;
}

}  // namespace
}  // namespace beamcam::scenes
