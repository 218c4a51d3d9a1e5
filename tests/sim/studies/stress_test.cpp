// Problems at the limits: budgets of steps, starts that do not exist, and events that repeat.
#include "tests/campaign/stress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

TEST(StressCampaign, DistinguishesRejectionsFromFailures) {
    using stress::Outcome;
    stress::StressCase one{"default", {}, 0.01};
    EXPECT_EQ(run_case(one).outcome, Outcome::closed);
    one.problem.cam->eccentricity = 1;
    EXPECT_EQ(run_case(one).outcome, Outcome::refused);
    one.problem = Problem{};
    one.problem.solver.max_steps = 3;
    const stress::StressResult spent = run_case(one);
    EXPECT_EQ(spent.outcome, Outcome::stopped);
    EXPECT_NE(spent.message.find("solver.max_steps"), std::string::npos) << spent.message;
}

TEST(Budget, OfStepsEndsTheRunWithAMessageAndPartialResults) {
    Problem p;
    p.solver.max_steps = 50;
    Request request;
    request.end_time = 1;
    request.tables.push_back({{0, 1}, {channel("theta")}});
    try {
        simulate(p, request);
        FAIL() << "fifty steps were enough";
    } catch (const SolverError& error) {
        EXPECT_NE(std::string(error.what()).find("the budget of 50 steps (solver.max_steps) is spent"),
                  std::string::npos)
            << error.what();
        EXPECT_GT(error.last_time, 0);
        EXPECT_EQ(error.partials.at(0).tables[0].values[0][0], p.initial.angle);
        EXPECT_TRUE(std::isnan(error.partials.at(0).tables[0].values[0][1]));
    }
}

// A beam so soft that it slides off the cam near its tip.
TEST(Starts, ThatDoNotExistAreReportedAndLeaveNothing) {
    Problem p;
    p.initial.shape = InitialShape::resting;
    p.beam.youngs_modulus = 1e6;
    p.cam->centre = {0.8, -0.1};
    p.cam->speed = 0;
    Request request;
    request.end_time = 0.01;
    try {
        simulate(p, request);
        ADD_FAILURE() << "it has a start after all";
    } catch (const SolverError& error) {
        EXPECT_THAT(error.what(), ::testing::StartsWith("at the start: no equilibrium"));
        EXPECT_TRUE(error.partials.empty());
    }
}

// A beam whose first step fails has a start, but no motion.
TEST(Starts, OfMotionsThatFailAtOnceLeaveNothing) {
    const stress::StressCase one = stress::mixture(300);
    EXPECT_EQ(run_case(one).outcome, stress::Outcome::stopped);
    Request request;
    request.end_time = one.end;
    try {
        simulate(one.problem, request);
        ADD_FAILURE() << "it moves after all";
    } catch (const SolverError& error) {
        EXPECT_TRUE(error.partials.empty());
    }
}

TEST(Starts, OfBeamsThatCannotRespondToAnImpulseAreRejected) {
    Problem p;
    p.beam.model = ModelKind::rigid;
    p.beam.basis = Basis::cantilever;
    p.hub.drive = ConstantSpeed{-1};
    p.contact.model = ContactModel::restitution;
    const std::vector<Issue> issues = validate(p);
    ASSERT_EQ(issues.size(), 1u);
    EXPECT_EQ(issues[0].path, "contact.model");
    EXPECT_TRUE(issues[0].fatal);
    p.contact.model = ContactModel::compliant;
    EXPECT_TRUE(validate(p).empty());
}

TEST(RepeatedEvents, OfAReboundLostInTheStepsOfAMultistepMethodEnd) {
    for (const Method method : {Method::cvode_adams, Method::cvode_bdf}) {
        Problem p;
        p.solver.method = method;
        set_tolerance(p, 1e-5);
        p.contact.model = ContactModel::restitution;
        p.initial = {0.41, -2, InitialShape::straight};
        const Result r = run(p, 0.06);
        EXPECT_FALSE(r.impacts.empty()) << name(method);
        EXPECT_LT(r.energy_residual_max, 1e-4 * r.energy_scale) << name(method);
    }
}

TEST(RepeatedEvents, OfBouncesAsLowAsRoundingOfTheGapEnd) {
    Problem p;  // the cam comes back at 30 m/s: bounces are pressed together within microseconds
    p.cam->speed = -300;
    p.cam->eccentricity = 0.099;
    p.contact.model = ContactModel::restitution;
    p.contact.friction = CoulombFriction{0.3, 1e-3};
    p.contact.offset.reset();
    p.initial = {0.376, -2, InitialShape::straight};
    const Result r = run(p, 0.02);
    EXPECT_GT(r.impacts.size(), 10u);
    EXPECT_LT(r.impacts.size(), 1000u);
}

TEST(RepeatedEvents, OfABristleThatCanNeitherStickNorSlideEnd) {
    Problem p = fixed_cam(ModelKind::rigid);
    p.hub.radius = 0.1;
    p.contact.offset = 0.05;
    p.contact.friction = StickSlipFriction{2, {}, {}};
    p.initial = {0.75, -2, InitialShape::straight};
    const Result r = run(p, 0.15);
    EXPECT_FALSE(r.impacts.empty());
    EXPECT_LT(r.energy_residual_max, 1e-6 * r.energy_scale);
}

}  // namespace
}  // namespace beamcam::sim::testing
