// The intervals in which a motion is reproducible, and the methods of the comparison.
#include "sim/run/horizon.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/sanitizers.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

using ::testing::HasSubstr;

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

TEST(Horizon, OfThePapersSystemIsATransientThatEnds) {
    SKIP_UNDER_SANITIZERS();
    for (const double speed : {0.0, 1.0}) {
        Problem p;
        p.cam->speed = speed;
        const Result r = with_horizon(p, 10);
        EXPECT_EQ(r.compared_with, "rk8 at rtol 1e-10") << speed;
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

TEST(Horizon, NeedsOneMoreRun) {
    SKIP_UNDER_SANITIZERS();
    Request request;
    request.end_time = 3;
    request.horizon = true;
    Effort effort;
    simulate(Problem{}, {&request, 1}, {}, &effort);
    EXPECT_EQ(effort.integrations, 2);
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
    p.beam.model = ModelKind::second_order;  // for which `auto` is rk8
    EXPECT_EQ(comparison(p, 1).problem.solver.method, Method::cvode_adams);
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
