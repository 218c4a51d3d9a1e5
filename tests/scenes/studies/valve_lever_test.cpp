// The gallery's valve lever, and the numbers of scenes/CAMS.md.
#include <gtest/gtest.h>

#include <numbers>

#include "sim/cam/lever.hpp"
#include "sim/run/simulate.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

sim::Problem valve_lever(double height) {
    sim::Problem p = read_scene(load_source(BEAMCAM_TEST_DIR "/../scenes/valve-lever.json")).scene->problem;
    std::get<sim::Rectangle>(*p.beam.section).height = height;
    return p;
}

constexpr double kRpm = std::numbers::pi / 30;

// A beam that starts at rest on the cam touches it once unless it jumps.
bool jumps(sim::Problem p, double rpm) {
    constexpr int kTurns = 6;
    p.cam->speed = rpm * kRpm;
    sim::Request request;
    request.end_time = kTurns * cam_period(p);
    return sim::simulate(p, request).impacts.size() > 1;
}

TEST(ValveLever, LeavesAtTheSpeedsOfTheTable) {
    struct Row {
        double height, rigid, flexible;  // [m], [rpm]
    };
    for (const Row& row : {Row{1e-3, 1944, 1300}, Row{1.2e-3, 1776, 1478}, Row{1.5e-3, 1591, 1369},
                           Row{2e-3, 1381, 1302}, Row{3e-3, 1133, 1127}, Row{6e-3, 812, 811}}) {
        const sim::Problem p = valve_lever(row.height);
        EXPECT_NEAR(sim::Lever(p).jump()->speed / kRpm, row.rigid, 0.6);
        EXPECT_FALSE(jumps(p, row.flexible - 1)) << row.height;
        EXPECT_TRUE(jumps(p, row.flexible + 1)) << row.height;
    }
}

TEST(ValveLever, ShowsAMotionBelowAndOneAboveTheJump) {
    const sim::Problem p = valve_lever(1.5e-3);
    EXPECT_FALSE(jumps(p, 1200));
    EXPECT_TRUE(jumps(p, 1600));
    sim::Request request;
    request.end_time = 6 * cam_period(p);
    for (const char* name : {"lift_error", "contact_force"}) request.extrema.push_back(*sim::channel_named(name));
    const sim::Result result = sim::simulate(p, request);
    EXPECT_NEAR(result.extrema[0].min, -0.019, 1e-3);
    EXPECT_NEAR(result.extrema[0].max, -0.012, 1e-3);
    EXPECT_GT(result.extrema[1].min, 0);
}

// Nothing moves at first, so that a first step by the slope is far longer than the contact's damping allows.
TEST(ValveLever, AllMethodsStartAtRest) {
    sim::Problem p = valve_lever(1.5e-3);
    sim::Request request;
    request.end_time = 1e-3;
    request.tables.push_back({{1e-3}, {*sim::channel_named("contact_force")}});
    const double force = sim::simulate(p, request).tables[0].values[0][0];
    for (const auto method : {sim::Method::rk8, sim::Method::cvode_adams, sim::Method::cvode_bdf}) {
        p.solver.method = method;
        EXPECT_NEAR(sim::simulate(p, request).tables[0].values[0][0], force, 1e-5 * force) << name(method);
    }
}

}  // namespace
}  // namespace beamcam::scenes
