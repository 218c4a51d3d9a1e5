#include "sim/studies/stress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

TEST(StressCampaign, HasTwoThousandCasesAndAQuickPartOnEveryPlate) {
    const Campaign full = stress_campaign(true), quick = stress_campaign(false);
    EXPECT_GE(full.cases.size(), 2000u);
    std::set<std::size_t> plates;
    for (const StressCase& one : quick.cases) plates.insert(one.plate);
    EXPECT_EQ(plates.size(), full.plates.size());
    EXPECT_LT(quick.cases.size(), full.cases.size() / 8);
}

TEST(StressCampaign, TellsRefusalsAndFailuresApart) {
    StressCase one;
    one.end = 0.01;
    EXPECT_EQ(survive(one).outcome, Outcome::closed);
    one.problem.cam->eccentricity = 1;
    EXPECT_EQ(survive(one).outcome, Outcome::refused);
    one.problem = Problem{};
    one.problem.solver.max_steps = 3;
    const StressResult spent = survive(one);
    EXPECT_EQ(spent.outcome, Outcome::stopped);
    EXPECT_NE(spent.words.find("solver.max_steps"), std::string::npos) << spent.words;
}

TEST(Budget, OfStepsEndsTheRunInWordsAndKeepsWhatWasReached) {
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

// Where not even a state to start from is found there is no partial trajectory, and no talk of steps.
TEST(Starts, ThatDoNotExistAreToldAndLeaveNothing) {
    int found = 0;
    for (const StressCase& one : stress_campaign(true).cases) {
        if (one.variant != "seed 91" && one.variant != "seed 300") continue;
        ++found;
        const StressResult result = survive(one);
        EXPECT_EQ(result.outcome, Outcome::stopped) << result.words;
        EXPECT_THAT(result.words, ::testing::StartsWith("at the start: no equilibrium"));
        Request request;
        request.end_time = one.end;
        try {
            simulate(one.problem, request);
            ADD_FAILURE() << "it has a start after all";
        } catch (const SolverError& error) {
            EXPECT_TRUE(error.partials.empty());
        }
    }
    EXPECT_EQ(found, 2);
}

TEST(Starts, OfWhatCannotGiveWayToAnImpulseAreRefused) {
    Problem p;
    p.beam.model = ModelKind::rigid;
    p.beam.basis = Basis::cantilever;
    p.hub.drive = ConstantSpeed{-1};
    p.contact.model = ContactModel::restitution;
    const std::vector<Finding> findings = validate(p);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].path, "contact.model");
    EXPECT_TRUE(findings[0].fatal);
    p.contact.model = ContactModel::compliant;
    EXPECT_TRUE(validate(p).empty());
}

TEST(Flips, OfAReboundLostInTheStepsOfAMultistepMethodEnd) {
    for (const Method method : {Method::cvode_adams, Method::cvode_bdf}) {
        Problem p;
        p.solver.method = method;
        p.solver.rtol = 1e-5;
        p.solver.atol = 1e-8;
        p.contact.model = ContactModel::restitution;
        p.initial = {0.41, -2, InitialShape::straight};
        const Result r = run(p, 0.06);
        EXPECT_FALSE(r.impacts.empty()) << name(method);
        EXPECT_LT(r.energy_residual_max, 1e-4 * r.energy_scale) << name(method);
    }
}

TEST(Flips, OfBouncesAsLowAsRoundingOfTheGapEnd) {
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

TEST(Flips, OfAGripThatCanNeitherHoldNorSlideEnd) {
    Problem p = fixed_cam(ModelKind::rigid);
    p.hub.radius = 0.1;
    p.contact.offset = 0.05;
    p.contact.friction = StickSlipFriction{2, {}, {}, {}};
    p.initial = {0.75, -2, InitialShape::straight};
    const Result r = run(p, 0.15);
    EXPECT_FALSE(r.impacts.empty());
    EXPECT_LT(r.energy_residual_max, 1e-6 * r.energy_scale);
}

}  // namespace
}  // namespace beamcam::sim::testing
