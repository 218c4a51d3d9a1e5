// The intervals in which a motion is reproducible, and the methods of the comparison.
#include "sim/run/horizon.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/sanitizers.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

Result with_horizon(const Problem& problem, double end) {
    Request request;
    request.end_time = end;
    request.horizon = true;
    return simulate(problem, request);
}

// From artificial angles of two computations at 1 kHz.
Result reproducibility_of(const std::vector<double>& ours, const std::vector<double>& theirs, double end_time) {
    const Problem problem;
    const double end = static_cast<double>(ours.size() - 2) / 1000;
    const Request angle = horizon_request(problem, end);
    Result a, b, result;
    a.tables.push_back({{}, {ours}});
    b.tables.push_back({{}, {theirs}});
    result.end_time = end_time;
    report_reproducibility(problem, angle, a, b, comparison(problem, end), result);
    return result;
}

TEST(Horizon, AgreementThatReturnsIsReported) {
    std::vector<double> a(1002, 0.5), b = a;
    for (std::size_t k = 300; k < 400; ++k) b[k] += 2e-6;
    b[350] = a[350];  // two motions that cross
    const Result r = reproducibility_of(a, b, 1);
    EXPECT_EQ(r.reproducible_until, 0.299);
    ASSERT_EQ(r.not_reproducible.size(), 1u);
    EXPECT_EQ(r.not_reproducible[0].from, 0.299);
    EXPECT_EQ(r.not_reproducible[0].to, 0.4);
    EXPECT_EQ(r.reproducible_again_from, 0.4);
    EXPECT_THAT(r.reproducibility, HasSubstr("until 0.299 s, not from 0.299 s to 0.4 s, again from 0.4 s on"));
    // Only up to the end of the result.
    EXPECT_TRUE(reproducibility_of(a, b, 0.2).not_reproducible.empty());
    EXPECT_EQ(reproducibility_of(a, b, 0.2).reproducible_until, 0.2);
    EXPECT_EQ(reproducibility_of(a, b, 0.35).not_reproducible.at(0).to, std::nullopt);
    EXPECT_EQ(reproducibility_of(a, b, 0.45).not_reproducible.at(0).to,
              std::nullopt);  // too brief to differ from a crossing
    EXPECT_EQ(reproducibility_of(a, b, 0.45).reproducible_again_from, std::nullopt);
}

TEST(Horizon, LostAgreementThatComesBackTwiceIsTwoIntervals) {
    std::vector<double> a(1002, 0), b = a;
    for (std::size_t k = 100; k < 200; ++k) b[k] = 1, b[k + 500] = 1;
    const Result r = reproducibility_of(a, b, 1);
    ASSERT_EQ(r.not_reproducible.size(), 2u);
    EXPECT_EQ(r.not_reproducible[1].from, 0.599);
    EXPECT_EQ(r.not_reproducible[1].to, 0.7);
    EXPECT_EQ(r.reproducible_again_from, 0.7);
}

TEST(Horizon, InstantsBeyondTheComparisonAreNotReproducible) {
    std::vector<double> a(1002, 0), b = a;
    for (std::size_t k = 600; k < b.size(); ++k) b[k] = std::nan("");
    const Result r = reproducibility_of(a, b, 1);
    EXPECT_EQ(r.reproducible_until, 0.599);
    EXPECT_EQ(r.not_reproducible.at(0).to, std::nullopt);
}

// At rest on the turning cam from the start.
Problem resting(double speed) {
    Problem p;
    p.initial.shape = InitialShape::resting;
    p.cam->speed = speed;
    return p;
}

TEST(Horizon, LastingContactIsComparedForSixTurns) {
    SKIP_UNDER_SANITIZERS();
    const Problem p = resting(5);
    Request request;
    request.horizon = true;
    const auto simulated = [&](double end, long& steps) {
        Effort effort;
        request.end_time = end;
        Result result = simulate(p, {&request, 1}, {}, &effort).front();
        steps = effort.spent.steps;
        return result;
    };
    long whole = 0, compared = 0;
    const Result settled = simulated(40, whole);
    ASSERT_FALSE(settled.impacts.back().t_end.has_value());
    EXPECT_TRUE(settled.not_reproducible.empty()) << settled.reproducibility;
    EXPECT_EQ(settled.reproducible_until, 40);
    EXPECT_NEAR(compared_until(p, settled, 40), settled.impacts.back().t_start + 12 * std::numbers::pi / 5, 1e-12);
    simulated(compared_until(p, settled, 40), compared);
    EXPECT_LT(whole, 2 * compared);
    // Not if the beam may still leave the cam, or if anything else changes with time.
    EXPECT_EQ(compared_until(p, settled, 1), 1);  // the end
    Problem other = p;
    other.hub.drive = HarmonicTorque{0.1, 3, 0};
    EXPECT_EQ(compared_until(other, settled, 40), 40);
    other = p;
    other.contact.friction = StickSlipFriction{};
    EXPECT_EQ(compared_until(other, settled, 40), 40);
    Result left = settled;
    left.impacts.back().t_end = 30;
    EXPECT_EQ(compared_until(p, left, 40), 40);
}

TEST(Horizon, SmallDifferencesThatMayGrowAreFollowedToTheEnd) {
    const Problem p = resting(5);
    const double until = 4, end = 104, window = 4 * std::numbers::pi / 5;
    const Request angle = cut(horizon_request(p, end), until);
    ASSERT_EQ(angle.tables[0].times.back(), until);
    const std::vector<double> ours(angle.tables[0].times.size(), 0.5);
    const auto agrees = [&](double by, std::size_t at) {
        std::vector<double> theirs = ours;
        theirs[at] += by;
        Result a, b;
        a.tables.push_back({{}, {ours}}), b.tables.push_back({{}, {theirs}});
        return agrees_for_good(p, angle, a, b, end);
    };
    const double most = 1e-6 / (1 + 100 / window);
    EXPECT_TRUE(agrees(0.99 * most, 3900));
    EXPECT_FALSE(agrees(1.01 * most, 3900));
    EXPECT_FALSE(agrees(std::nan(""), 3900));
    EXPECT_TRUE(agrees(1, 100));  // before those turns
}

TEST(Horizon, OfThePapersSystemIsATransientThatEnds) {
    SKIP_UNDER_SANITIZERS();
    for (const double speed : {0.0, 1.0}) {
        Problem p;
        p.cam->speed = speed;
        const Result r = with_horizon(p, 10);
        EXPECT_THAT(r.compared_with, MatchesRegex("rk8 at rtol 1e-10, from 2\\..* s on with auto at rtol 1e-10"))
            << speed;
        EXPECT_GT(*r.reproducible_until, 1) << speed;
        EXPECT_LT(*r.reproducible_until, 3) << speed;
        ASSERT_FALSE(r.not_reproducible.empty());
        ASSERT_TRUE(r.reproducible_again_from.has_value()) << r.reproducibility;
        EXPECT_GT(*r.reproducible_again_from, 4) << speed;
        EXPECT_LT(*r.reproducible_again_from, 9.5) << speed;
        EXPECT_EQ(r.not_reproducible.back().to, r.reproducible_again_from);
        for (const Interval& lost : r.not_reproducible) EXPECT_LT(lost.from, lost.to);
    }
}

// Another method runs until the motion differs from a run of its own at a tighter tolerance, or has settled.
TEST(Horizon, NeedsTheOtherMethodOnlyWhereItMayTellMore) {
    const Problem p;
    EXPECT_TRUE(tighter_is_cheap(p));
    Problem other = p;
    other.solver.method = Method::rk8;
    EXPECT_FALSE(tighter_is_cheap(other));
    const Request angle = horizon_request(p, 20);
    const std::vector<double> ours(angle.tables[0].times.size(), 0.5);
    Result plain, tighter;
    plain.tables.push_back({{}, {ours}}), tighter.tables.push_back({{}, {ours}});
    EXPECT_EQ(other_needed_until(p, angle, plain, tighter), 20);
    plain.impacts.emplace_back().t_start = 7;  // and stays
    EXPECT_NEAR(other_needed_until(p, angle, plain, tighter), 7 + 0.25 * 2 * std::numbers::pi / p.cam->speed, 1e-12);
    tighter.tables[0].values[0][3000] += 2e-6;
    EXPECT_EQ(other_needed_until(p, angle, plain, tighter), 3);
}

TEST(Horizon, OfAMinuteCostsAFewTimesTheMotion) {
    SKIP_UNDER_SANITIZERS();
    const Problem p;
    Request request;
    request.end_time = 60;
    Effort motion, both;
    simulate(p, {&request, 1}, {}, &motion);
    request.horizon = true;
    const Result r = simulate(p, {&request, 1}, {}, &both).front();
    EXPECT_LT(both.spent.rhs_evaluations, 4 * motion.spent.rhs_evaluations) << r.reproducibility;
    // The motion, the tighter run, the other method; the last two again up to the end if the final part does not agree.
    EXPECT_LE(both.integrations, 5);
}

TEST(Horizon, ComparesWithAnotherMethodWhereverOneIsFeasible) {
    Problem p;
    EXPECT_EQ(comparison(p, 1).problem.solver.method, Method::rk8);
    p.solver.method = Method::rk8;
    EXPECT_EQ(comparison(p, 1).problem.solver.method, Method::cvode_adams);
    p.solver.method = Method::automatic;
    p.beam.model = ModelKind::exact;
    EXPECT_EQ(comparison(p, 1).problem.solver.method, Method::rk8);
    p.hub.drive = ConstantSpeed{1};
    EXPECT_EQ(comparison(p, 1).problem.solver.method, Method::rk8);
    p.hub.drive = FreeDrive{};
    p.beam.model = ModelKind::first_order;
    EXPECT_FALSE(comparison(p, 1).same_method);
    p.beam.modes = 40;
    EXPECT_TRUE(comparison(p, 10).same_method);
    EXPECT_EQ(comparison(p, 10).problem.solver.method, Method::automatic);
    p.beam.modes = 10;
    EXPECT_THAT(with_horizon(p, 0.3).compared_with, HasSubstr("rk8"));
    p.beam.modes = 2;
    p.beam.damping_ratio = {1000};  // an explicit method follows the decay in steps of a microsecond
    EXPECT_TRUE(comparison(p, 10).same_method);
}

}  // namespace
}  // namespace beamcam::sim::testing
