#include "sim/observe/channels.hpp"

#include <cmath>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

TEST(Channels, NamesAndBackAgain) {
    Problem p;
    p.beam.modes = 12;
    const std::vector<Channel> all = all_channels(p);
    EXPECT_EQ(all.size(), kChannels.size() - 2 + 2 * 12);  // the rows of q and q_dot are those of all modes
    for (const Channel& c : all) {
        const auto back = channel_named(name(c));
        ASSERT_TRUE(back) << name(c);
        EXPECT_EQ(*back, c);
    }
}

TEST(Channels, RefuseNamesThatAreNone) {
    for (const char* text : {"", "q", "q0", "q01", "q-1", "q1x", "q_dot", "q0_dot", "q1_do", "q1_dotx", "Theta", "theta ", "q99999999999999999999"})
        EXPECT_FALSE(channel_named(text)) << text;
}

TEST(Channels, HaveUnits) {
    Problem p;
    EXPECT_STREQ(unit(channel("theta_dot"), p), "rad/s");
    EXPECT_STREQ(unit(channel("q2"), p), "m");
    EXPECT_STREQ(unit(channel("q2_dot"), p), "m/s");
    p.beam.model = ModelKind::exact;
    EXPECT_STREQ(unit(channel("q2"), p), "rad");
    EXPECT_STREQ(unit(channel("q2_dot"), p), "rad/s");
}

TEST(Channels, OfTheContactAreEmptyWithoutACam) {
    const Problem p = falling_beam(ModelKind::rigid);
    for (const char* text : {"contact_force", "friction_force", "gap", "contact_x", "contact_s", "cam_angle",
                             "separation", "separation_paper", "work_cam"})
        EXPECT_TRUE(std::isnan(series(p, text, {0.1})[0])) << text;
}

TEST(Channels, OfTheTipAreThoseOfTheRootTangentInBothBases) {
    for (const Basis basis : {Basis::cantilever, Basis::hub_beam}) {
        const Problem p = falling_beam(ModelKind::first_order, basis, 2);
        Request request;
        request.tables.push_back(
            {{0.2, 0.2 + 1e-6, 0.2 - 1e-6},
             {channel("tip_deflection"), channel("tip_rate"), channel("theta"), channel("theta_dot")}});
        request.poses.push_back({{0.2}, 3});
        const Result r = simulate(p, request);
        const auto& v = r.tables[0].values;
        EXPECT_NEAR((v[0][1] - v[0][2]) / 2e-6, v[1][0], 1e-7) << name(basis);
        EXPECT_NEAR((v[2][1] - v[2][2]) / 2e-6, v[3][0], 1e-7) << name(basis);
        const Pose& pose = r.poses[0][0];
        EXPECT_EQ(pose.theta, v[2][0]);
        EXPECT_NEAR(cross(unit(pose.theta), pose.centreline.back() - pose.centreline.front()), v[0][0], 1e-15);
    }
}

TEST(Channels, RatesOfTheModesAreTheirDerivatives) {
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::exact}) {
        Problem p;
        p.beam.model = kind;
        p.beam.modes = 3;
        set_tolerance(p, 1e-12);
        const double h = 4e-6;
        for (const double t : {0.1, 0.45})
            for (const char* mode : {"q1", "q2", "q3"}) {
                const std::vector<double> q = series(p, mode, {t - 2 * h, t - h, t + h, t + 2 * h});
                const double slope = (q[0] - 8 * q[1] + 8 * q[2] - q[3]) / (12 * h);
                const double rate = series(p, (std::string(mode) + "_dot").c_str(), {t})[0];
                EXPECT_NEAR(rate, slope, 1e-6 * std::fabs(rate) + 1e-8) << name(kind) << " " << mode << " " << t;
            }
    }
}

TEST(Channels, ContactArcRunsCounterClockwiseFromTheMark) {
    Problem p = fixed_cam(ModelKind::rigid);
    p.initial.angle = 1;
    for (double phase : {0.0, 1.0, -2.0}) {
        p.cam->phase = phase;
        Request request;
        request.tables.push_back({{0}, {channel("contact_s"), channel("cam_angle")}});
        request.poses.push_back({{0}, 2});
        const Result r = simulate(p, request);
        const Nearest& nearest = *r.poses[0][0].nearest;
        const double expected =
            std::remainder(std::atan2(nearest.normal.y, nearest.normal.x) - phase, 2 * 3.14159265358979323846);
        const double s = r.tables[0].values[0][0] / p.cam->radius;
        EXPECT_NEAR(std::remainder(s - expected, 2 * 3.14159265358979323846), 0, 1e-14);
        EXPECT_GE(s, 0);
        EXPECT_EQ(r.tables[0].values[1][0], phase);
    }
}

}  // namespace
}  // namespace beamcam::sim::testing
