#include "sim/studies/accuracy.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/sim/support.hpp"

namespace beamcam::sim {
namespace {

AccuracyRequest quick(double end) {
    AccuracyRequest request;
    request.end_time = end;
    request.repeats = 1;
    request.longest_run = 30;  // sanitizers are slow; nothing here is meant to be left out
    request.rtols = {1e-3, 1e-6, 1e-10};
    request.methods = {Method::automatic, Method::rk8, Method::cvode_adams};
    request.modes = {3, 5, 8};
    return request;
}

Problem falling() {
    Problem p = testing::falling_beam(ModelKind::first_order);
    testing::set_tolerance(p, 1e-8);
    return p;
}

void methods_come_nearer_as_their_tolerances_tighten(const Accuracy& found) {
    EXPECT_DOUBLE_EQ(found.until, 0.1);
    EXPECT_LT(found.reference_error, 1e-11);
    ASSERT_EQ(found.work.size(), 9u);
    for (std::size_t i = 0; i < found.work.size(); i += 3) {
        ASSERT_TRUE(found.work[i].error && found.work[i + 2].error) << name(found.work[i].method);
        EXPECT_LT(*found.work[i + 2].error, 1e-2 * *found.work[i].error) << name(found.work[i].method);
        EXPECT_LT(*found.work[i + 2].error, 1e-8) << name(found.work[i].method);
        EXPECT_GT(found.work[i + 2].steps, found.work[i].steps) << name(found.work[i].method);
    }
}

// A freely falling beam is a rigid rod to 1e-5: shapes and models have small effects of a known order.
void shapes_and_models_are_compared_with_the_best(const Accuracy& found) {
    EXPECT_EQ(found.most_modes, 8);
    ASSERT_EQ(found.modes.size(), 4u);  // the scene's own two as well
    EXPECT_EQ(*found.modes[3].error, 0);
    EXPECT_LT(*found.modes[1].error, *found.modes[0].error);
    EXPECT_LT(*found.modes[0].error, 1e-4);
    EXPECT_EQ(found.best_model, ModelKind::second_order);
    ASSERT_EQ(found.models.size(), 4u);
    EXPECT_EQ(found.models.front().model, ModelKind::rigid);
    EXPECT_EQ(*found.models.back().error, 0);
    EXPECT_GT(*found.models.front().error, 1e-7);  // the rigid rod lags by the bending
    EXPECT_LT(*found.models.front().error, 1e-3);
    EXPECT_TRUE(found.contact.empty());
}

void the_recommendation_is_the_loosest_tolerance_that_serves(const Accuracy& found) {
    ASSERT_TRUE(found.recommendation);
    for (const WorkRow& row : found.work) {
        if (row.method != Method::automatic) continue;
        if (row.rtol > found.recommendation->rtol) {
            EXPECT_GT(*row.error, found.target / 2);
        } else if (row.rtol == found.recommendation->rtol) {
            EXPECT_LE(*row.error, found.target / 2);
        }
    }
    EXPECT_GT(found.recommendation->seconds, 0);
}

// Several checks of one assessment.
TEST(Accuracy, OfAFallingBeam) {
    SKIP_UNDER_SANITIZERS();
    AccuracyRequest request = quick(0.1);
    request.target = 1e-6;
    // `exact` with the same assertions would take minutes under a sanitizer.
    request.models = {ModelKind::second_order, ModelKind::first_order, ModelKind::zeroth_order, ModelKind::rigid};
    const Accuracy found = assess(falling(), request);
    methods_come_nearer_as_their_tolerances_tighten(found);
    shapes_and_models_are_compared_with_the_best(found);
    the_recommendation_is_the_loosest_tolerance_that_serves(found);
}

// The different shapes of the models contribute less than the models do: after an impact first-order beams differ from
// the elastica by some 1e-5, and six coordinates of the elastica from twenty by 1e-2.
TEST(Accuracy, ModelsAreComparedWithEnoughShapes) {
    SKIP_UNDER_SANITIZERS();
    AccuracyRequest request = quick(0.5);
    request.methods = {Method::automatic};
    request.rtols = {1e-8};
    request.modes = {2};
    request.models = {ModelKind::exact, ModelKind::first_order};
    const Accuracy found = assess(Problem{}, request);
    ASSERT_EQ(found.models.size(), 2u);
    EXPECT_EQ(found.best_model, ModelKind::exact);
    EXPECT_GT(*found.models.front().error, 1e-8);
    EXPECT_LT(*found.models.front().error, 1e-4);
}

// The time of comparison equals the reproducible horizon of the summary.
TEST(Accuracy, ItEndsWhereTheMotionIsNoLongerReproducible) {
    Problem p;
    AccuracyRequest request = quick(1.8);
    request.methods = {Method::rk8};
    request.rtols = {1e-8};
    request.modes = {1};
    request.models = {ModelKind::zeroth_order};
    p.beam.modes = 1;
    p.beam.model = ModelKind::zeroth_order;
    Request plain;
    plain.end_time = 1.8;
    plain.horizon = true;
    const double horizon = *simulate(p, plain).reproducible_until;
    ASSERT_LT(horizon, 1.75);
    std::vector<double> shares;
    const Accuracy found = assess(p, request, [&](double share) {
        shares.push_back(share);
        return true;
    });
    // The first runs already move it, although how many follow is not known.
    EXPECT_TRUE(std::ranges::any_of(shares, [](double share) { return share > 0 && share < 0.1; }));
    EXPECT_TRUE(std::ranges::is_sorted(shares));
    EXPECT_LE(std::ranges::max(shares), 1);
    EXPECT_NEAR(found.until, horizon, 0.1);
    EXPECT_LT(found.until, found.end_time);
    ASSERT_EQ(found.contact.size(), 3u);
    EXPECT_GT(*found.contact[0].error, 1e-3);  // 1 % of the stiffness is far more than rtol
}

// The angle of a driven hub has no error, but the tip's deflection has.
TEST(Accuracy, OfADrivenHubIsTheTips) {
    Problem p;
    p.cam.reset();
    p.hub.drive = ConstantSpeed{0};
    p.beam.model = ModelKind::first_order;
    p.beam.youngs_modulus = 1e8;
    p.initial = {0, 0, InitialShape::straight};
    AccuracyRequest request = quick(0.5);
    request.models = {ModelKind::rigid, ModelKind::first_order};
    const Accuracy found = assess(p, request);
    EXPECT_TRUE(found.of_tip);
    for (const WorkRow& row : found.work)
        if (row.method == Method::rk8 && row.rtol > 1e-4) {
            EXPECT_GT(*row.error, 1e-12);
        }
    ASSERT_EQ(found.modes.size(), 4u);
    EXPECT_GT(*found.modes.front().error, 1e-6);
    // The rigid beam does not bend: all of the deflection, several percent of the length, is its error.
    EXPECT_GT(*found.models.front().error, 0.01);
}

TEST(Accuracy, HorizonOfADrivenHubIsTheTips) {
    SKIP_UNDER_SANITIZERS();
    // A driven beam on a fast cam is not reproducible, although its hub is.
    Problem p;
    p.hub.drive = ConstantSpeed{-0.1};
    p.initial = {0.45, 0, InitialShape::straight};
    p.cam->speed = 40;
    p.beam.youngs_modulus = 2e9;
    testing::set_tolerance(p, 1e-4);
    Request request;
    request.end_time = 4;
    request.horizon = true;
    const Result r = simulate(p, request);
    ASSERT_GT(r.impacts.size(), 3u);
    EXPECT_LT(*r.reproducible_until, 4);
}

// With one impact, no few modes reach the target: what holds until the impact alone is no recommendation for the whole.
TEST(Accuracy, SaysIfNoSettingsReachTheTarget) {
    SKIP_UNDER_SANITIZERS();
    Problem p;
    p.initial.angle = 0.6;
    AccuracyRequest request = quick(0.3);
    request.methods = {Method::automatic};
    request.models = {ModelKind::first_order};
    request.target = 1e-6;
    const Accuracy found = assess(p, request);
    ASSERT_TRUE(found.recommendation);
    EXPECT_LT(found.recommendation->until, 0.3);
    EXPECT_EQ(
        found.recommendation->text.find("no number of modes that was tried gives θ to 1e-06 rad until 0.3 s; rtol "),
        0U);
    request.target = 1;
    EXPECT_EQ(assess(p, request).recommendation->text.find("rtol "), 0U);
}

// Each within the target, rtol 1e-3 and twelve modes leave it together before the end of the time stated for both.
TEST(Accuracy, RecommendsAToleranceAndModesThatWereMeasuredTogether) {
    SKIP_UNDER_SANITIZERS();
    const Problem p;
    AccuracyRequest request;
    request.end_time = 0.7;
    request.repeats = 1;
    request.longest_run = 30;
    request.methods = {Method::automatic};
    request.models = {ModelKind::first_order};
    const Accuracy found = assess(p, request);
    ASSERT_TRUE(found.recommendation);
    const auto angles = [&](int modes, double rtol) {
        Problem variant = p;
        variant.beam.modes = modes;
        variant.solver.atol *= rtol / p.solver.rtol;
        variant.solver.rtol = rtol;
        Request samples;
        samples.end_time = found.recommendation->until;
        TableRequest table;
        table.channels = {{ChannelKind::theta, 0}};
        for (int k = 0; k <= 1000; ++k) table.times.push_back(samples.end_time * k / 1000);
        samples.tables.push_back(std::move(table));
        return simulate(variant, samples).tables[0].values[0];
    };
    const auto truth = angles(found.most_modes, p.solver.rtol),
               mine = angles(found.recommendation->modes, found.recommendation->rtol);
    for (std::size_t k = 0; k < truth.size(); ++k) ASSERT_LE(std::fabs(mine[k] - truth[k]), 1.1 * request.target) << k;
}

TEST(Accuracy, StopsWhenAsked) {
    EXPECT_THROW(assess(falling(), quick(0.1), [](double share) { return share < 0.2; }), Interrupted);
}

}  // namespace
}  // namespace beamcam::sim
