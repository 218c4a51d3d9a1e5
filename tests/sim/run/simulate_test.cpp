// Whole runs: exact properties of the system.
#include "sim/run/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

// ---- flight -----------------------------------------------------------------------------

TEST(FallingBeam, IsTheSameForAllConsistentModelsToTheTermsTheyDifferBy) {
    SKIP_UNDER_SANITIZERS();
    // u_f in gravity is first-order's; second-order and exact add (v′)⁴ ~ 1e-16, so only convergence in N separates
    // them.
    std::vector<double> times;
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order}) {
        Problem p = falling_beam(kind, Basis::automatic, 2);
        p.solver.rtol = 1e-10;
        p.solver.atol = 1e-14;
        times.push_back(run(p, 0.38).theta_zero.at(0).t);
    }
    EXPECT_NEAR(times[0], times[1], 1e-10);
}

TEST(FallingBeam, TendsToTheRigidRodAsItStiffens) {
    double before = 1;
    for (double stiffer : {1.0, 10.0, 100.0}) {
        Problem p = falling_beam(ModelKind::first_order, Basis::hub_beam, 2);
        p.beam.youngs_modulus *= stiffer;
        const double late = std::fabs(run(p, 0.38).theta_zero.at(0).t - 0.369998497559697);
        EXPECT_LT(late, 1e-5 / stiffer);
        EXPECT_LT(late, before);
        before = late;
    }
}

// ---- conservation --------------------------------------------------------------------------------

TEST(Energy, IsConstantInFreeFlight) {
    for (const ModelKind kind :
         {ModelKind::rigid, ModelKind::zeroth_order, ModelKind::first_order, ModelKind::second_order, ModelKind::exact})
        for (double radius : {0.0, 0.2, -0.2}) {
            Problem p = falling_beam(kind, Basis::automatic, kind == ModelKind::exact ? 2 : 3);
            p.beam.youngs_modulus = 1e9;  // soft: bends much, vibrates slowly
            p.hub.radius = radius;
            p.hub.inertia = 0.01;
            p.solver.rtol = 1e-11;
            const Result r = run(p, 0.15);
            EXPECT_LT(r.energy_residual_max, 1e-10 * r.energy_scale) << name(kind) << " " << radius;
        }
}

TEST(Energy, IsNotConstantInThePapersEquation) {
    Problem p = falling_beam(ModelKind::paper, Basis::cantilever, 2);
    p.beam.youngs_modulus = 1e9;  // softer: the defect shows
    const Result r = run(p, 0.5);
    EXPECT_GT(r.energy_residual_max, 1e-7 * r.energy_scale);
}

TEST(Ledger, ClosesWithinTenTolerancesOnTheDefaultScene) {
    for (double rtol : {1e-6, 1e-8, 1e-10}) {
        Problem p;
        set_tolerance(p, rtol);
        const Result r = run(p, 1);
        EXPECT_LT(r.energy_residual_max, 10 * rtol * r.energy_scale) << rtol;
    }
}

// ---- events --------------------------------------------------------------------------------------

TEST(Touch, OfTheRigidRodIsWhereTheTangentFromTheHingeTouchesTheDisc) {
    Dice dice(26);
    for (int repeat = 0; repeat < 8; ++repeat) {
        Problem p = fixed_cam(ModelKind::rigid);
        p.cam->eccentricity = dice.between(0, 0.03);
        p.cam->phase = dice.about_zero(3);
        p.solver.rtol = 1e-13;
        p.solver.atol = 1e-15;
        const Result r = run(p, 0.4);
        ASSERT_FALSE(r.impacts.empty());
        const double e = p.cam->eccentricity, d = 0.25, b2 = d * d + e * e + 2 * d * e * std::cos(p.cam->phase);
        const double theta =
            std::atan2(e * std::sin(p.cam->phase), d + e * std::cos(p.cam->phase)) + std::asin(0.1 / std::sqrt(b2));
        EXPECT_NEAR(r.impacts[0].x, std::sqrt(b2 - 0.01), 1e-11);
        EXPECT_NEAR(series(p, "theta", {r.impacts[0].t_start})[0], theta, 1e-11);
        // Speed by conservation of energy.
        const double omega = std::sqrt(3 * 9.81 * (std::sin(kQuarterTurn) - std::sin(theta)));
        EXPECT_NEAR(r.impacts[0].v_n_before, -omega * r.impacts[0].x, 1e-10);
    }
}

TEST(Impacts, OfTheFirstSecondAreThoseOfATighterTolerance) {
    Problem p;
    const Result loose = run(p, 1);
    set_tolerance(p, 1e-11);
    const Result tight = run(p, 1);
    ASSERT_EQ(loose.impacts.size(), tight.impacts.size());
    ASSERT_GE(tight.impacts.size(), 4u);
    for (std::size_t i = 0; i < tight.impacts.size(); ++i) {
        EXPECT_NEAR(loose.impacts[i].t_start, tight.impacts[i].t_start, 1e-6) << i;
        EXPECT_NEAR(*loose.impacts[i].t_end, *tight.impacts[i].t_end, 1e-6) << i;
        EXPECT_EQ(loose.impacts[i].collision, tight.impacts[i].collision) << i;
    }
}

TEST(Impacts, AreThoseOfEveryIntegrator) {
    Problem p;
    const Result reference = run(p, 0.78);
    for (const Method method : {Method::rk8, Method::cvode_adams, Method::cvode_bdf}) {
        p.solver.method = method;
        const Result r = run(p, 0.78);
        ASSERT_EQ(r.impacts.size(), reference.impacts.size()) << name(method);
        for (std::size_t i = 0; i < r.impacts.size(); ++i)
            EXPECT_NEAR(r.impacts[i].t_start, reference.impacts[i].t_start, 2e-5) << name(method) << " " << i;
    }
}

TEST(Impacts, ShareOneCollisionWhenTheyAreClose) {
    Problem p;
    const Result grouped = run(p, 1);
    p.contact.collision_gap = 0;
    const Result single = run(p, 1);
    EXPECT_EQ(single.collisions.size(), single.impacts.size());
    EXPECT_LT(grouped.collisions.size(), grouped.impacts.size());
    int count = 0;
    double lost = 0;
    for (const Collision& c : grouped.collisions) count += c.count;
    for (const Impact& i : grouped.impacts) lost += i.energy_lost;
    EXPECT_EQ(count, static_cast<int>(grouped.impacts.size()));
    double together = 0;
    for (const Collision& c : grouped.collisions) together += c.energy_lost;
    EXPECT_NEAR(lost, together, 1e-15);
}

TEST(Impacts, LoseTheEnergyOfTheBalance) {
    Problem p;
    p.contact.friction = CoulombFriction{0.3, 1e-3};
    Request request;
    request.tables.push_back({{1}, {channel("loss_contact"), channel("loss_friction")}});
    const Result r = simulate(p, request);
    double lost = 0;
    for (const Impact& i : r.impacts) lost += i.energy_lost;
    EXPECT_NEAR(lost, r.tables[0].values[0][0] + r.tables[0].values[1][0], 1e-12);
    EXPECT_GT(lost, 0);
}

TEST(Impacts, AGrazingPairIsFoundAtEveryTolerance) {
    // ω = 0, two modes: two contacts lie less than a tenth of a millisecond apart late in the first second.
    Problem p = fixed_cam(ModelKind::first_order, 2);
    std::size_t count = 0;
    for (double rtol : {1e-11, 1e-9, 1e-7}) {
        set_tolerance(p, rtol);
        const std::size_t found = run(p, 0.62).impacts.size();
        if (count) {
            EXPECT_EQ(found, count) << rtol;
        }
        count = found;
    }
}

TEST(Start, OnTheCamAtRestTouchesAtOnce) {
    Problem p = fixed_cam(ModelKind::rigid);
    p.cam->eccentricity = 0;
    p.initial.angle = std::asin(0.4);
    const Result r = run(p, 0.5);
    ASSERT_FALSE(r.impacts.empty());
    EXPECT_LT(r.impacts[0].t_start, 1e-3);
    EXPECT_FALSE(r.warnings.empty());  // slower than the approach floor, which is reported
    EXPECT_LT(r.energy_residual_max, 1e-7 * r.energy_scale);
}

TEST(Start, InContactIsATouchEvenOfARunWithoutLength) {
    Problem p;
    p.initial.shape = InitialShape::resting;
    const Result r = run(p, 0);
    ASSERT_EQ(r.impacts.size(), 1u);
    EXPECT_EQ(r.impacts[0].t_start, 0);
    EXPECT_FALSE(r.impacts[0].t_end);
    EXPECT_EQ(r.collisions.size(), 1u);
}

TEST(Start, RestingOnAFixedCamStaysThere) {
    for (const ModelKind kind : {ModelKind::rigid, ModelKind::first_order, ModelKind::second_order, ModelKind::exact}) {
        Problem p = fixed_cam(kind);
        p.initial.shape = InitialShape::resting;
        const Extremum theta = extremum(p, "theta", 0.1);
        EXPECT_LT(theta.max - theta.min, 1e-10) << name(kind);
        // N x = ½mgL cos θ.
        const double force = series(p, "contact_force", {0})[0], x = series(p, "contact_x", {0})[0];
        EXPECT_NEAR(force * x, 0.5 * p.beam.line_density() * 9.81 * std::cos(theta.max), 1e-3) << name(kind);
    }
}

TEST(Start, RestingOnATurningCamMovesWithIt) {
    Problem p;
    p.beam.model = ModelKind::rigid;
    p.initial.shape = InitialShape::resting;
    p.cam->speed = 3;
    const Result r = run(p, 2);
    EXPECT_EQ(r.impacts.size(), 1u);  // it never leaves
    EXPECT_FALSE(r.impacts[0].t_end.has_value());
}

TEST(Start, StaticBeamReleasedFromADriveBeginsAtRest) {
    Problem p = falling_beam(ModelKind::first_order, Basis::cantilever, 6);
    p.initial.shape = InitialShape::static_equilibrium;
    p.initial.angle = 0.2;
    p.hub.drive = ConstantSpeed{0};
    const Extremum tip = extremum(p, "tip_deflection", 0.3);
    EXPECT_LT(tip.max - tip.min, 1e-9 * std::fabs(tip.min));  // held, it stays in equilibrium
}

// Also where rounding makes the first rate positive.
TEST(Start, FromRestIsNoApex) {
    for (const ModelKind model : {ModelKind::first_order, ModelKind::second_order, ModelKind::exact})
        for (const Basis basis : {Basis::hub_beam, Basis::cantilever})
            for (const int modes : {1, 2, 3, 5})
                for (const double damping : {0.0, 0.01, 1.5})
                    for (int degrees = -80; degrees <= 60; degrees += 10) {
                        Problem p;
                        p.cam.reset();
                        p.beam.model = model;
                        p.beam.basis = basis;
                        p.beam.modes = modes;
                        p.beam.damping_ratio = {damping};
                        p.hub.inertia = 0.01;
                        p.initial.angle = degrees * std::numbers::pi / 180;
                        Request request;
                        request.end_time = 0.01;
                        request.apexes = true;
                        for (const Apex& apex : simulate(p, request).apexes)
                            EXPECT_GT(apex.t, 1e-6) << modes << " modes at " << degrees << " degrees";
                    }
}

TEST(Cam, OfEitherDirectionGivesTheMirroredWork) {
    // Centred and rough: the work of the cam on the beam's friction changes sign with the speed, to first order.
    Problem p;
    p.beam.model = ModelKind::rigid;
    p.hub.radius = 0.1;
    p.cam->eccentricity = 0;
    p.contact.offset = 0.02;
    p.contact.friction = CoulombFriction{0.1, 1e-3};
    p.cam->speed = 20;
    const double forward = series(p, "work_cam", {0.5})[0];
    p.cam->speed = -20;
    const double backward = series(p, "work_cam", {0.5})[0];
    EXPECT_GT(forward, 0);
    EXPECT_GT(backward, 0);  // friction of a turning cam always costs the cam
}

TEST(Cam, PressedThroughHasAClearMessage) {
    Problem p = fixed_cam(ModelKind::rigid);
    p.contact.stiffness = 10;
    try {
        run(p, 1);
        FAIL() << "the beam fell through the disc";
    } catch (const SolverError& error) {
        EXPECT_NE(std::string(error.what()).find("contact.stiffness"), std::string::npos) << error.what();
        EXPECT_GT(error.last_time, 0.2);
        EXPECT_EQ(error.partials.at(0).impacts.size(), 1u);
    }
}

TEST(StickSlip, HoldsARestingBeamAndSlidesUnderAFastCam) {
    Problem p = fixed_cam(ModelKind::rigid);
    p.hub.radius = 0.1;
    p.contact.offset = 0.02;
    p.contact.friction = StickSlipFriction{0.3, 0.5, 1e6};
    p.initial.shape = InitialShape::resting;
    const std::vector<double> held = series(p, "friction_force", {0.05, 0.1});
    const double force = series(p, "contact_force", {0.1})[0];
    EXPECT_LT(std::fabs(held[1]), 0.5 * force);
    p.cam->eccentricity = 0;
    p.cam->speed = 5;
    const Result r = run(p, 0.05);
    EXPECT_FALSE(r.impacts.empty());
    EXPECT_NEAR(std::fabs(series(p, "friction_force", {0.05})[0]), 0.3 * series(p, "contact_force", {0.05})[0], 1e-9);
}

TEST(StickSlip, WithoutACoefficientIsNoFriction) {
    for (const std::optional<double> stiffness : {std::optional<double>{}, std::optional<double>{1e9}}) {
        Problem p;
        p.cam->speed = 0;
        p.initial = {.angle = 0.41, .angular_velocity = -2};  // slides both ways within the touch
        const double smooth = series(p, "theta", {0.06})[0];
        p.contact.friction = StickSlipFriction{0, {}, stiffness};
        EXPECT_EQ(extremum(p, "friction_force", 0.06).max, 0);
        EXPECT_EQ(series(p, "theta", {0.06})[0], smooth);
    }
}

TEST(PrescribedDrive, BendsTheBeamOverTheCamAndKeepsTheLedger) {
    Problem p = fixed_cam(ModelKind::exact, 2);
    p.beam.youngs_modulus = 3e9;
    p.hub.drive = ConstantSpeed{-1};
    Request request;
    request.tables.push_back({{0.5}, {channel("contact_force"), channel("work_drive"), channel("theta")}});
    const Result r = simulate(p, request);
    EXPECT_NEAR(r.tables[0].values[2][0], kQuarterTurn - 0.5, 1e-14);
    EXPECT_GT(r.tables[0].values[0][0], 10);
    EXPECT_GT(r.tables[0].values[1][0], 0.1);
    EXPECT_LT(r.energy_residual_max, 1e-7 * r.energy_scale);
    EXPECT_GE(r.impacts.size(), 1u);
}

TEST(PrescribedDrive, DoesNotAskForInertiaThatNothingUses) {
    // A driven beam has no inertia limit.
    Problem p = fixed_cam(ModelKind::first_order, 2);
    p.hub.drive = ConstantSpeed{-1};
    EXPECT_NO_THROW(run(p, 0.62));
}

TEST(FirstRebound, ConvergesToTheSameApexInBothBases) {
    // 0.7228 rad with many modes (MODEL.md §16); six modes of either basis are within 5e-4 of it.
    for (const Basis basis : {Basis::hub_beam, Basis::cantilever}) {
        Problem p = fixed_cam(ModelKind::first_order, 6);
        p.beam.basis = basis;
        set_tolerance(p, 1e-7);
        const Result r = run(p, 0.62);
        double apex = 0;
        for (const Apex& a : r.apexes)
            if (a.t > 0.35) apex = std::max(apex, a.theta);
        EXPECT_NEAR(apex, 0.7228, 5e-4) << name(basis);
    }
}

// ---- extremes -------------------------------------------------------------------------------------

struct Extreme {
    const char* name;
    std::function<void(Problem&)> push;
};

class Extremes : public ::testing::TestWithParam<Extreme> {};

TEST_P(Extremes, EndWithFiniteNumbersAndAClosedLedger) {
    Problem p;
    GetParam().push(p);
    Request request;
    request.tables.push_back({{0.1, 0.3}, all_channels(p)});
    request.extrema = {channel("theta"), channel("contact_force")};
    const Result r = simulate(p, request);
    EXPECT_EQ(r.end_time, 0.3);
    for (const auto& column : r.tables[0].values)
        for (double value : column) EXPECT_TRUE(std::isfinite(value));
    EXPECT_LT(r.energy_residual_max, 1e3 * p.solver.rtol * (r.energy_scale + 1e-12));
}

INSTANTIATE_TEST_SUITE_P(Of, Extremes,
                         ::testing::Values(Extreme{"SoftContact", [](Problem& p) { p.contact.stiffness = 3e3; }},
                                           Extreme{"HardContact", [](Problem& p) { p.contact.stiffness = 1e12; }},
                                           Extreme{"FastCam", [](Problem& p) { p.cam->speed = 500; }},
                                           Extreme{"FastCamBackwards", [](Problem& p) { p.cam->speed = -500; }},
                                           Extreme{"NoGravity", [](Problem& p) { p.gravity = 0; }},
                                           Extreme{"Upwards", [](Problem& p) { p.gravity = -9.81; }},
                                           Extreme{"HeavyHub",
                                                   [](Problem& p) {
                                                       p.hub.inertia = 1e6;
                                                       p.initial.angular_velocity = -1.4;
                                                   }},
                                           Extreme{"LooseTolerance",
                                                   [](Problem& p) {
                                                       p.solver.rtol = 1e-2;
                                                       p.solver.atol = 1e-6;
                                                   }},
                                           Extreme{"OneMode", [](Problem& p) { p.beam.modes = 1; }},
                                           Extreme{"AtTheTip",
                                                   [](Problem& p) {
                                                       p.cam->centre = {0.99, 0};
                                                       p.cam->eccentricity = 0;
                                                   }},
                                           Extreme{"TinyStop",
                                                   [](Problem& p) {
                                                       p.cam->radius = 2e-3;
                                                       p.cam->eccentricity = 0;
                                                   }},
                                           Extreme{"RootBeyondTheAxis", [](Problem& p) { p.hub.radius = -0.4; }},
                                           Extreme{"StrongDamping", [](Problem& p) { p.beam.damping_ratio = {1.5}; }},
                                           Extreme{"LinearContactWithoutLoss",
                                                   [](Problem& p) {
                                                       p.contact.exponent = 1;
                                                       p.contact.damping = DampingLaw::none;
                                                       p.contact.stiffness = 1e6;
                                                   }},
                                           Extreme{"PlasticImpact", [](Problem& p) { p.contact.restitution = 0; }},
                                           Extreme{"MetreLongButHair",
                                                   [](Problem& p) {
                                                       p.beam.second_moment = 1e-13;
                                                       p.beam.area = 1e-6;
                                                       p.beam.model = ModelKind::exact;
                                                   }}),
                         [](const auto& extreme) { return extreme.param.name; });

}  // namespace
}  // namespace beamcam::sim::testing
