#include "sim/problem/number_keys.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace beamcam::sim {
namespace {

TEST(NumberKeys, AreThoseOfTheProblemAsItIs) {
    Problem p;
    const auto has = [&](const char* path) {
        const std::vector<NumberKey> keys = number_keys(p);
        return std::ranges::find(keys, path, &NumberKey::path) != keys.end();
    };
    for (const char* path : {"cam.speed", "cam.centre.0", "beam.modes", "contact.restitution", "gravity",
                             "initial.angle", "initial.angular_velocity", "solver.rtol"})
        EXPECT_TRUE(has(path)) << path;
    EXPECT_FALSE(has("hub.drive.value"));
    p.hub.drive = ConstantTorque{2};
    EXPECT_TRUE(has("hub.drive.value"));
    p.cam.reset();
    EXPECT_FALSE(has("cam.speed"));
}

TEST(NumberKeys, TakeEveryNumberAndGiveItBack) {
    Problem p;
    p.hub.drive = HarmonicTorque{1, 2, 3};
    p.contact.friction = StickSlipFriction{0.1, 0.2, 3.0};
    p.beam.damping_ratio = {0.1, 0.2};
    for (const NumberKey& key : number_keys(p)) {
        const double value = key.whole ? 3 : 0.4375;
        ASSERT_TRUE(set_number(p, key.path, value)) << key.path;
        const std::vector<NumberKey> after = number_keys(p);
        EXPECT_EQ(std::ranges::find(after, key.path, &NumberKey::path)->value, value) << key.path;
    }
}

// One number applies to all modes.
TEST(NumberKeys, OneNumberStandsForAListOfModes) {
    Problem p;
    for (const std::vector<double>& before : {std::vector<double>{}, std::vector<double>{0.1, 0.2}}) {
        p.beam.damping_ratio = before;
        EXPECT_TRUE(set_number(p, "beam.damping_ratio", 0.05));
        EXPECT_EQ(p.beam.damping_ratio, std::vector<double>{0.05});
    }
}

TEST(NumberKeys, RejectUnknownKeysAndFractionsOfIntegers) {
    Problem p;
    EXPECT_FALSE(set_number(p, "cam.spee", 1));
    EXPECT_FALSE(set_number(p, "cam.centre.2", 1));
    EXPECT_FALSE(set_number(p, "beam.modes", 2.5));
    EXPECT_FALSE(set_number(p, "beam.modes", 41));
    EXPECT_EQ(p.beam.modes, 2);
}

}  // namespace
}  // namespace beamcam::sim
