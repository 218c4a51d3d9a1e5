// Lyapunov exponents: sum rules, a settled and a chaotic motion, near-grazing impacts.
#include "sim/orbit/exponents.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <numeric>

#include "tests/sim/cam/profiles.hpp"
#include "tests/sim/orbit/pressed_beam.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

double sum(const Exponents& e) { return std::accumulate(e.lambda.begin(), e.lambda.end(), 0.0); }

TEST(Exponents, PeriodicMotionHasTheExponentsOfItsMultipliers) {
    // Between fold and period doubling: a stable orbit with one impact per turn.
    const Exponents e = lyapunov_exponents(PressedBeam().on_orbit(45), {0, 20, 50, 10});
    ASSERT_EQ(e.lambda.size(), 2u);
    EXPECT_LT(e.lambda[0], 0);
    EXPECT_FALSE(e.chaotic());
    const double impacts_per_second = 45 / (2 * std::numbers::pi);
    EXPECT_NEAR(sum(e), 2 * impacts_per_second * std::log(0.5), 0.05);  // one impact more or less in 50 s
}

// An impact multiplies volumes by r², the damper of the hub by e^(−c/J) a second, whatever the outline.
TEST(Exponents, SumOfARigidBeamOnAProfileIsThatOfImpactsAndDamper) {
    const LawProfile law{14 * kDegree,
                         {{MotionLaw::cycloidal, 3 * kDegree, {}}, {MotionLaw::cycloidal, -3 * kDegree, {}}}};
    LawProfile halves = law;
    halves.segments.front().over = std::numbers::pi;
    const PointsProfile oval = points_of(
        360, [](double alpha) { return std::pair(0.08 + 0.004 * std::cos(2 * alpha), -0.008 * std::sin(2 * alpha)); });
    for (const Profile& profile : {Profile(halves), Profile(oval)}) {
        Problem p = PressedBeam().problem(120);
        p.cam->profile = profile;
        p.cam->centre = {0.25, 0};
        p.contact.restitution = 0.9;
        p.hub.spring = {2, -0.5, 0.01};
        p.initial.angle = 0.7;
        p.solver.method = Method::automatic;
        const Exponents e = lyapunov_exponents(p, {0, 0, 20, 10});
        const double inertia = p.beam.line_density() * std::pow(p.beam.length, 3) / 3;
        ASSERT_GT(e.impacts, 20);
        ASSERT_TRUE(std::isfinite(sum(e)));
        EXPECT_NEAR(sum(e), 2 * std::log(0.9) * static_cast<double>(e.impacts) / 20 - 0.01 / inertia, 1e-6);
    }
}

// A leaf follows a cam of arcs over their joints.
TEST(Exponents, OfSustainedContactOverAJumpOfTheRadiusAreRefused) {
    Problem p = with_profile(tangent_arcs());
    p.hub.spring = {0.6, -0.7, 0};
    p.beam.length = 0.12;
    p.beam.section = Rectangle{0.012, 0.0015};
    p.beam.material = Material::steel;
    p.beam.damping_ratio = {0.01};
    p.cam->centre = {0.1, 0};
    p.cam->speed = 10.5;
    p.contact.model = ContactModel::restitution;
    p.contact.restitution = 0.5;
    p.initial.shape = InitialShape::resting;
    try {
        lyapunov_exponents(p, {0, 0, 1, 10});
        FAIL() << "the exponents were computed";
    } catch (const SolverError& refusal) {
        EXPECT_THAT(refusal.what(), ::testing::HasSubstr("tangents are not known"));
        EXPECT_THAT(refusal.what(), ::testing::HasSubstr("curvature does not jump"));
        EXPECT_THAT(refusal.what(), ::testing::Not(::testing::HasSubstr("steps")));
    }
}

// Differences from an upright rod grow by √(3 g/2 L), but it stands still.
TEST(Exponents, AnUnstableEquilibriumIsNoChaos) {
    Problem problem = PressedBeam().on_orbit(45);
    problem.cam.reset();
    problem.hub.drive = FreeDrive{};
    problem.gravity = 9.81;
    problem.initial = {.angle = std::numbers::pi / 2};
    const Exponents e = lyapunov_exponents(problem, {1, 0, 4, 10});
    EXPECT_NEAR(e.lambda[0], std::sqrt(1.5 * 9.81 / problem.beam.length), 0.3);
    EXPECT_FALSE(e.chaotic());
}

// Differences of a free rotor grow in proportion to the time.
TEST(Exponents, LinearGrowthIsNoChaos) {
    Problem problem = PressedBeam().on_orbit(45);
    problem.cam.reset();
    problem.hub.drive = FreeDrive{};
    const Exponents e = lyapunov_exponents(problem, {0, 0, 100, 20});
    EXPECT_GT(e.lambda[0], 0);
    EXPECT_FALSE(e.chaotic());
}

// Σλ = 2ν ln r − 2Σζω, exactly, with the impacts of the same run.                                            (S73)
TEST(Exponents, SumIsThatOfImpactsAndDamping) {
    SKIP_UNDER_SANITIZERS();
    struct Case {
        int modes;
        double ratio, restitution, duration;
        ModelKind model = ModelKind::first_order;
    };
    for (const Case& c : {Case{0, 0, 0.5, 20},
                          {1, 0, 0.9, 0.3},
                          {1, 2e-3, 0.9, 0.3},
                          {2, 0, 0.9, 0.2},
                          {2, 2e-3, 0.9, 0.2},
                          {8, 0, 0.98, 0.2},
                          {8, 1e-3, 0.98, 0.2},
                          {2, 0, 0.9, 0.2, ModelKind::exact},
                          {2, 0, 0.9, 0.2, ModelKind::second_order}}) {
        Problem p = PressedBeam().on_orbit(54);
        if (c.modes > 0) {  // falling under gravity: pressed, it would chatter and rest on the cam
            p = Problem{};
            p.beam.model = c.model;
            p.beam.modes = c.modes;
            p.beam.damping_ratio = {c.ratio};
            p.cam->speed = 12;
            p.hub.radius = 0.05;
            p.contact.model = ContactModel::restitution;
            p.initial.angle = 0.6;
        }
        p.contact.restitution = c.restitution;
        set_tolerance(p, 1e-12);
        const Exponents e = lyapunov_exponents(p, {0, 0, c.duration, 2});
        double expected = 2 * static_cast<double>(e.impacts) / c.duration * std::log(c.restitution);
        System system(p);
        for (int i = 0; i < c.modes; ++i) expected -= 2 * c.ratio * system.model().frequency(i);
        EXPECT_GT(e.impacts, 2);
        ASSERT_TRUE(std::isfinite(sum(e))) << c.modes;
        EXPECT_NEAR(sum(e), expected, 1e-9 * std::fabs(expected)) << c.modes << " modes, ratio " << c.ratio;
    }
}

// The damping of a lasting contact is faster than that of the motion by orders of magnitude: θ̈ falls by
// N D ℓ²/(J δ̇₋) per θ̇, where Nℓ is the moment of the weight.
TEST(Exponents, SumOfABeamAtRestIsTheDampingOfItsContact) {
    Problem p;
    p.beam.model = ModelKind::rigid;
    p.cam->speed = 0;
    p.initial.shape = InitialShape::resting;
    p.contact.approach_floor.value = 1e-4;
    set_tolerance(p, 1e-12);
    System system(p);
    const InitialState start = initial_state(p);
    system.set_phase(start.phase);
    const ContactState c = system.contact(0, start.y.data());
    const double lever = c.x, inertia = system.model().linearize().mass(0, 0);
    const double rate = c.force * system.normal_law().damping / start.phase.approach * lever * lever / inertia;
    ASSERT_GT(rate, 1e4);
    EXPECT_NEAR(sum(lyapunov_exponents(p, {0, 0.01, 0.05, 5})), -rate, 1e-4 * rate);
}

// The approach speed of a touch, which undamped contact does not need, takes no part.
TEST(Exponents, SumOfConservativeContactVanishesDuringATouch) {
    Problem p;
    p.cam->speed = 12;
    p.contact.damping = DampingLaw::none;
    p.contact.stiffness = 1e6;
    p.initial.angle = 0.6;
    set_tolerance(p, 1e-12);
    const Exponents e = lyapunov_exponents(p, {0, 0, 0.2, 2});  // the touch lasts from 0.191 s to 0.213 s
    EXPECT_EQ(e.impacts, 1);
    EXPECT_NEAR(sum(e), 0, 1e-8);
}

TEST(Exponents, ChaosHasAPositiveExponentThatALongerRunConfirms) {
    SKIP_UNDER_SANITIZERS();
    const Problem p = PressedBeam().on_orbit(54);
    const ExponentsRequest request{1, 20, 800, 20};
    Exponents e = lyapunov_exponents(p, request);
    EXPECT_TRUE(e.chaotic()) << e.lambda[0] << " ± " << e.error[0];
    confirm_chaos(p, request, e);
    EXPECT_TRUE(e.chaotic());
    const Exponents longer = lyapunov_exponents(p, {1, 20, 8000, 20});
    EXPECT_NEAR(e.lambda[0], longer.lambda[0], 0.02 * longer.lambda[0]) << "± " << e.error[0];
    EXPECT_LT(longer.error[0], 0.5 * e.error[0]);
    EXPECT_NEAR(e.lambda[0], longer.lambda[0], 3 * e.error[0]);
    // By a program that knows only the parabolas and the saltation matrix, over 8 times 200 000 turns: 1.985 ± 0.001.
    EXPECT_NEAR(longer.lambda[0], 1.985, 3 * longer.error[0]);
}

// Sixty turns from each of many starts on one attractor: blocks of three turns, between which growth is correlated,
// state no error that is too small.
TEST(Exponents, ErrorsOfShortRunsCoverTheirScatter) {
    SKIP_UNDER_SANITIZERS();
    constexpr double kLongRun = 1.985;  // as above
    constexpr int kStarts = 30;
    double squares = 0;
    for (int k = 0; k < kStarts; ++k) {
        Problem p = PressedBeam().on_orbit(54);
        p.initial.angle += 1e-5 * k;
        const Exponents e = lyapunov_exponents(p, {1, 20, 60 * cam_period(p), 20});
        const double deviation = (e.lambda[0] - kLongRun) / e.error[0];
        EXPECT_LT(std::fabs(deviation), 4) << k << ": " << e.lambda[0] << " ± " << e.error[0];
        squares += deviation * deviation;
    }
    EXPECT_LT(std::sqrt(squares / kStarts), 1.3);
    EXPECT_GT(std::sqrt(squares / kStarts), 0.2);
}

TEST(Exponents, TheContributionOfNearGrazingImpactsIsNoProofOfChaos) {
    Exponents e;
    e.lambda = {1}, e.error = {0.1}, e.duration = 100, e.impacts = 50;
    EXPECT_EQ(e.chaos(), Chaos::shown);
    e.doubt = 0.6;
    EXPECT_EQ(e.chaos(), Chaos::shown);
    e.doubt = 0.8;  // 1 < 3 × 0.1 + 0.8
    EXPECT_EQ(e.chaos(), Chaos::doubtful);
    EXPECT_FALSE(e.chaotic());
    e.error = {0.4};
    EXPECT_EQ(e.chaos(), Chaos::not_shown);
}

TEST(Exponents, ASensitiveTransientIsNoChaos) {
    SKIP_UNDER_SANITIZERS();
    const Problem p;  // its differences grow until about 4 s and are gone at 9 s
    const ExponentsRequest request{.count = 1, .transient = 2, .duration = 4};
    Exponents e = lyapunov_exponents(p, request);
    ASSERT_TRUE(e.chaotic());  // as far as these seconds alone can say
    confirm_chaos(p, request, e);
    EXPECT_FALSE(e.chaotic());
    EXPECT_THAT(e.warnings.back(), ::testing::HasSubstr("transient"));
}

TEST(Exponents, AnAverageThatStartsBeforeTheMotionHasSettledIsReported) {
    EXPECT_TRUE(lyapunov_exponents(PressedBeam().on_orbit(45), {1, 20, 50, 10}).settled);
    EXPECT_TRUE(lyapunov_exponents(PressedBeam().on_orbit(54), {1, 20, 200, 20}).settled);
    // Started on the unstable orbit beyond the period doubling, it takes some seconds to leave for the doubled one.
    const Exponents leaving = lyapunov_exponents(PressedBeam().on_orbit(52), {1, 0, 25, 10});
    EXPECT_FALSE(leaving.settled);
    EXPECT_FALSE(leaving.warnings.empty());
}

TEST(Exponents, SustainedContactForgetsAtOnce) {
    const Exponents e = lyapunov_exponents(PressedBeam().problem(5), {0, 20, 5, 5});
    EXPECT_EQ(e.lambda, std::vector<double>(2, -std::numeric_limits<double>::infinity()));
    EXPECT_FALSE(e.chaotic());
    EXPECT_FALSE(e.warnings.empty());
}

// Sustained contact annihilates all tangents. It occurs once in some fifty turns of this chaotic motion, at turns
// that rounding chooses: in the transient it is forgotten.
TEST(Exponents, RestDuringTheTransientIsForgotten) {
    const PressedBeam b{0.002, 0.85};
    constexpr double kTransient = 1500;
    const Exponents whole = lyapunov_exponents(b.on_orbit(52), {0, 0, kTransient, 10});
    EXPECT_EQ(whole.lambda[0], -std::numeric_limits<double>::infinity());
    int finite = 0;
    for (int window = 0; window < 8; ++window) {
        const Exponents e = lyapunov_exponents(b.on_orbit(52), {0, kTransient + 25 * window, 25, 5});
        if (!std::isfinite(e.lambda[0])) continue;
        ++finite;
        const double expected = 2 * static_cast<double>(e.impacts) / e.duration * std::log(b.restitution);
        EXPECT_NEAR(sum(e), expected, 0.01 * std::fabs(expected)) << window;
    }
    EXPECT_GE(finite, 2);
}

// The slowest impacts at the end of chatter cannot be linearized.
TEST(Exponents, NearGrazingImpactsAreCountedAndWarnedOf) {
    const Exponents regular = lyapunov_exponents(PressedBeam().on_orbit(45), {1, 5, 20, 5});
    EXPECT_EQ(regular.near_grazing, 0);
    EXPECT_TRUE(regular.warnings.empty());
    const Exponents chattering = lyapunov_exponents(PressedBeam().on_orbit(60), {1, 0, 50, 5});
    EXPECT_GT(chattering.near_grazing, 0);
    EXPECT_THAT(chattering.warnings.front(), ::testing::HasSubstr("near grazing"));
}

}  // namespace
}  // namespace beamcam::sim::testing
