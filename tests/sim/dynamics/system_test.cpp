// Contact geometry, forces and the balance of powers, at random states.
#include "sim/dynamics/system.hpp"

#include <cmath>
#include <numbers>

#include "sim/base/numerics.hpp"
#include "tests/sim/cam/profiles.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

struct ContactCase {
    ModelKind model;
    Basis basis;
    double radius, offset;
    int friction;          // 0 none, 1 coulomb, 2 stick-slip
    bool profile = false;  // a cam of the lift and return law, and a spring with a damper at the hub
};

Problem contact_problem(const ContactCase& c) {
    Problem p;
    p.beam.model = c.model;
    p.beam.basis = c.basis;
    p.beam.modes = 3;
    p.beam.youngs_modulus = 1e9;
    p.beam.damping_ratio = {0.03};
    p.hub.radius = c.radius;
    p.hub.inertia = 0.02;
    p.hub.drive = ConstantTorque{0.7};
    p.cam->speed = 7;
    p.contact.stiffness = 1e5;
    p.contact.offset = c.offset;
    if (c.profile) {
        p.cam->profile = lift_and_return();
        p.hub.spring = {3, -0.2, 0.1};
    }
    if (c.friction == 1) p.contact.friction = CoulombFriction{0.3, 0.1};
    if (c.friction == 2) p.contact.friction = StickSlipFriction{0.3, 0.4, 2e4};
    return p;
}

std::string contact_case_name(const ::testing::TestParamInfo<ContactCase>& info) {
    const ContactCase& c = info.param;
    const char* friction[] = {"Frictionless", "Coulomb", "StickSlip"};
    return label(name(c.model)) + label(name(c.basis)) + (c.radius != 0 ? "Radius" : "") +
           (c.offset > 0 ? "Offset" : "") + (c.profile ? "Profile" : "") + friction[c.friction];
}

// A state in which the beam is pressed `depth` into the cam near x.
std::vector<double> pressed_state(System& system, Dice& dice, double depth, double t) {
    const int n = system.coordinates();
    std::vector<double> y(static_cast<std::size_t>(system.size), 0.0);
    const double size = system.problem().beam.model == ModelKind::exact ? 0.03 : 0.004;
    for (int i = 1; i < n; ++i) {
        y[static_cast<std::size_t>(i)] = dice.about_zero(size / (i * i));
        y[static_cast<std::size_t>(n + i)] = dice.about_zero(20 * size / i);
    }
    y[static_cast<std::size_t>(n)] = dice.about_zero(2);
    const auto gap = [&](double theta) {
        y[0] = theta;
        return system.contact(t, y.data()).gap + depth;
    };
    y[0] = find_root(gap, 0.2, 1.4);
    y[static_cast<std::size_t>(2 * n)] = dice.about_zero(1e-3);  // the bristle, where there is one
    return y;
}

// A state at 0.1 s in which the beam presses on the cam, in one phase of friction after the other.
std::vector<double> state_in_contact(System& system, Dice& dice, int count, bool touching) {
    Phase phase;
    system.set_phase(phase);
    std::vector<double> y = pressed_state(system, dice, 2e-3, 0.1);
    phase.touching = touching;
    phase.approach = 5;  // the force is not clamped
    phase.friction = static_cast<FrictionState>(count % 3);
    system.set_phase(phase);
    return y;
}

// Distance of a point from the cam: the largest of its distances beyond the tangents.
double distance_from_cam(const System& system, double t, Vec2 point) {
    double distance = -1e9;
    const TurningCam& cam = system.cam();
    for (int i = 0; i < 20000; ++i) {
        const double alpha = 2 * std::numbers::pi * i / 20000;
        distance = std::max(distance, dot(point - cam.axis(), unit(alpha + cam.angle(t))) - cam.shape().at(alpha).h);
    }
    return distance;
}

class ContactTest : public ::testing::TestWithParam<ContactCase> {};

TEST_P(ContactTest, FootIsTheNearestPoint) {
    const Problem p = contact_problem(GetParam());
    System system(p);
    Dice dice(11);
    for (int repeat = 0; repeat < 6; ++repeat) {
        const std::vector<double> y = pressed_state(system, dice, dice.between(-0.1, 0.001), 0.3);
        const ContactState c = system.contact(0.3, y.data());
        const auto gap_at = [&](double x) {
            BeamPoint at;
            system.model().point(x, at);
            return distance_from_cam(system, 0.3, at.r) - system.offset();
        };
        EXPECT_NEAR(gap_at(c.x), c.gap, 1e-8);  // half a step of the angles squared, times a radius
        for (int i = -20; i <= 20; ++i) EXPECT_GE(gap_at(std::clamp(c.x + 1e-3 * i, 0.0, p.beam.length)), c.gap - 2e-8);
        for (int i = 0; i <= 40; ++i) EXPECT_GE(gap_at(p.beam.length * i / 40), c.gap - 2e-8);
        BeamPoint point;
        system.model().point(c.x, point);
        const Vec2 disc = c.disc.centre;
        if (!c.at_end) {
            EXPECT_NEAR(dot(point.r1, point.r - disc), 0, 1e-12);
        }
        EXPECT_NEAR(norm(c.normal), 1, 1e-14);
        EXPECT_NEAR(dot(c.normal, c.tangent), 0, 1e-15);
        EXPECT_NEAR(cross(c.tangent, c.normal), 1, 1e-14);  // t is n turned by −90°
    }
}

TEST_P(ContactTest, GapRateIsTheDerivativeOfTheGap) {
    const Problem p = contact_problem(GetParam());
    System system(p);
    Dice dice(12);
    for (int repeat = 0; repeat < 4; ++repeat) {
        const std::vector<double> y = pressed_state(system, dice, 1e-3, 0.2);
        const double t = 0.2;
        const int n = system.coordinates();
        const double rate = system.contact(t, y.data()).gap_rate;
        const double slope = scalar_slope_at_zero(
            [&](double e) {
                std::vector<double> z = y;
                for (int i = 0; i < n; ++i) z[static_cast<std::size_t>(i)] += e * y[static_cast<std::size_t>(n + i)];
                return system.contact(t + e, z.data()).gap;
            },
            1e-4);
        EXPECT_NEAR(slope, rate, 1e-9);
    }
}

// The gap of a motion with constant ξ̇, whose second derivative is g̈ at ξ̈ = 0 (S44).
TEST_P(ContactTest, GapAccelerationIsTheDerivativeOfTheGapRate) {
    Problem p = contact_problem(GetParam());
    p.gravity = 0;
    p.hub.drive = FreeDrive{};
    System system(p);
    const ContactGeometry geometry(p, system.model(), system.cam());
    Dice dice(15);
    for (int repeat = 0; repeat < 4; ++repeat) {
        const std::vector<double> y = pressed_state(system, dice, 1e-3, 0.2);
        const int n = system.coordinates();
        const double slope = scalar_slope_at_zero(
            [&](double e) {
                std::vector<double> z = y;
                for (int i = 0; i < n; ++i) z[static_cast<std::size_t>(i)] += e * y[static_cast<std::size_t>(n + i)];
                return system.contact(0.2 + e, z.data()).gap_rate;
            },
            1e-5);
        const ContactState c = system.contact(0.2, y.data());
        EXPECT_NEAR(slope, geometry.gap_acceleration_at_rest(system.model(), 0.2, c), 1e-6 * (1 + std::fabs(slope)));
    }
}

TEST_P(ContactTest, PowerOnTheBeamIsWorkOfTheCamLessWhatTheContactTakes) {
    const Problem p = contact_problem(GetParam());
    System system(p);
    Dice dice(13);
    for (int repeat = 0; repeat < 6; ++repeat) {
        const std::vector<double> y = state_in_contact(system, dice, repeat, true);
        const int n = system.coordinates();
        std::vector<double> dy(y.size());
        system.rhs(0.1, y.data(), dy.data());
        const ContactState c = system.contact(0.1, y.data());
        std::vector<double> jx(static_cast<std::size_t>(n)), jy(jx), jchi(jx);
        system.model().jacobian(c.x, jx.data(), jy.data(), jchi.data());
        double power = 0;
        for (int i = 0; i < n; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const Vec2 f = c.force * c.normal + c.friction * c.tangent;
            power += (jx[k] * f.x + jy[k] * f.y + system.offset() * c.friction * jchi[k]) *
                     y[static_cast<std::size_t>(n + i)];
        }
        const double* ledger = dy.data() + system.ledger_at;
        const double size = c.force * (std::fabs(c.gap_rate) + 1) + std::fabs(c.friction) * (std::fabs(c.slip) + 1);
        EXPECT_GT(c.force, 0);
        EXPECT_NEAR(power, ledger[kWorkCam] - ledger[kNormalWork] - ledger[kFrictionWork], 1e-13 * size);
    }
}

// The total of the energy balance along the flow has a zero rate.
TEST_P(ContactTest, LedgerIsConstantAlongTheFlow) {
    const Problem p = contact_problem(GetParam());
    System system(p);
    Dice dice(14);
    for (int repeat = 0; repeat < 6; ++repeat) {
        const bool touching = repeat < 5;
        const std::vector<double> y = state_in_contact(system, dice, repeat, touching);
        std::vector<double> dy(y.size());
        system.rhs(0.1, y.data(), dy.data());
        const auto total = [&](double e) {
            std::vector<double> z = y;
            for (std::size_t i = 0; i < z.size(); ++i) z[i] += e * dy[i];
            const ContactState c = system.contact(0.1 + e, z.data());
            System::EnergyBalance balance = system.balance_without_beam(z.data(), c);
            balance.energies = system.model().energies();
            if (system.spring()) balance.spring = system.spring()->energy(system.model().hub_angle());
            return balance.total();
        };
        const double h = 1e-7, drift = scalar_slope_at_zero(total, h);
        const ContactState c = system.contact(0.1, y.data());
        const double power = std::fabs(c.force) * (1 + std::fabs(c.gap_rate)) + std::fabs(c.friction * c.slip) + 10;
        EXPECT_NEAR(drift, 0, 1e-6 * power) << "grip " << repeat % 3;
    }
}

INSTANTIATE_TEST_SUITE_P(Every, ContactTest,
                         ::testing::Values(ContactCase{ModelKind::rigid, Basis::automatic, 0, 0, 0},
                                           ContactCase{ModelKind::rigid, Basis::automatic, -0.1, 0.02, 1},
                                           ContactCase{ModelKind::zeroth_order, Basis::hub_beam, 0, 0.02, 1},
                                           ContactCase{ModelKind::first_order, Basis::hub_beam, 0, 0, 0},
                                           ContactCase{ModelKind::first_order, Basis::hub_beam, 0.05, 0.0184, 1},
                                           ContactCase{ModelKind::first_order, Basis::cantilever, 0, 0.0184, 2},
                                           ContactCase{ModelKind::first_order, Basis::hub_beam, -0.1, 0.0184, 2},
                                           ContactCase{ModelKind::second_order, Basis::hub_beam, 0.05, 0.0184, 1},
                                           ContactCase{ModelKind::second_order, Basis::cantilever, -0.1, 0.01, 2},
                                           ContactCase{ModelKind::exact, Basis::automatic, 0, 0, 0},
                                           ContactCase{ModelKind::exact, Basis::automatic, 0.05, 0.0184, 1},
                                           ContactCase{ModelKind::exact, Basis::automatic, -0.05, 0.0184, 2},
                                           ContactCase{ModelKind::rigid, Basis::automatic, 0, 0, 0, true},
                                           ContactCase{ModelKind::first_order, Basis::hub_beam, 0.02, 0.0184, 1, true},
                                           ContactCase{ModelKind::second_order, Basis::cantilever, 0, 0.01, 0, true},
                                           ContactCase{ModelKind::exact, Basis::automatic, 0.02, 0.0184, 2, true}),
                         contact_case_name);

TEST(ContactGeometry, TouchesTheTipWhenTheDiscLiesBeyond) {
    Problem p = fixed_cam(ModelKind::rigid);
    p.cam->centre = {1.3, 0};
    p.cam->eccentricity = 0;
    System system(p);
    std::vector<double> y(static_cast<std::size_t>(system.size), 0.0);
    y[0] = 0.5;
    const ContactState c = system.contact(0, y.data());
    EXPECT_EQ(c.x, 1);
    EXPECT_TRUE(c.at_end);
    EXPECT_NEAR(c.gap, norm(unit(0.5) - Vec2{1.3, 0}) - 0.1, 1e-15);
}

TEST(ContactGeometry, TouchesTheTipHoweverNearTheDiscPassesIt) {
    Problem p;
    p.beam.model = ModelKind::rigid;
    p.cam->eccentricity = 0;
    p.cam->speed = 0;
    for (const double beyond : {1e-3, 1e-9, 1e-13}) {
        p.cam->centre = {p.beam.length + beyond, -p.cam->radius};
        const double y[2] = {};
        System system(p);
        const ContactState c = system.contact(0, y);
        EXPECT_TRUE(c.at_end) << beyond;
        EXPECT_EQ(c.x, p.beam.length) << beyond;
        EXPECT_GE(c.gap, std::hypot(beyond, p.cam->radius) - p.cam->radius - 1e-15);
    }
}

TEST(ContactGeometry, RootIsAnEndToo) {
    Problem p = fixed_cam(ModelKind::rigid);
    p.hub.radius = 0.5;
    System system(p);
    std::vector<double> y(static_cast<std::size_t>(system.size), 0.0);
    y[0] = 1.2;
    const ContactState c = system.contact(0, y.data());
    EXPECT_EQ(c.x, 0);
    EXPECT_TRUE(c.at_end);
}

TEST(ContactGeometry, CamTurnsClockwiseForPositiveSpeed) {
    Problem p;
    p.cam->speed = 2;
    p.cam->phase = 0.3;
    const System system(p);
    const OsculatingDisc pose = system.cam().disc(0.25, {0, 1});
    EXPECT_NEAR(system.cam().angle(0.25), 0.3 - 0.5, 1e-16);
    EXPECT_NEAR(pose.centre.x, 0.25 + 0.02 * std::cos(-0.2), 1e-16);
    EXPECT_NEAR(pose.velocity.x, 0.02 * -2 * -std::sin(-0.2), 1e-16);
    EXPECT_NEAR(pose.velocity.y, 0.02 * -2 * std::cos(-0.2), 1e-16);
}

TEST(ContactGeometry, RimOfAClockwiseCamRunsTowardsTheTipAboveIt) {
    // A rod at rest on the centred disc: the material below it moves along +t, so v_t is −ωR.
    Problem p;
    p.cam->eccentricity = 0;
    p.cam->speed = 3;
    p.beam.model = ModelKind::rigid;
    System system(p);
    std::vector<double> y(static_cast<std::size_t>(system.size), 0.0);
    y[0] = std::asin(0.1 / 0.25);
    const ContactState c = system.contact(0, y.data());
    EXPECT_NEAR(c.gap, 0, 1e-16);
    EXPECT_NEAR(c.x, std::sqrt(0.25 * 0.25 - 0.01), 1e-15);
    EXPECT_NEAR(c.slip, -0.3, 1e-15);
    EXPECT_GT(dot(c.tangent, unit(y[0])), 0.999);
}

TEST(ContactGeometry, BoundOfTheGapIsABound) {
    for (const ModelKind kind : {ModelKind::rigid, ModelKind::first_order, ModelKind::second_order, ModelKind::exact})
        for (const double radius : {-0.1, 0.0, 0.2, 0.02}) {
            Problem p;
            if (radius == 0.02) p.cam->profile = lift_and_return();
            p.beam.model = kind;
            p.beam.modes = 6;
            p.hub.radius = radius;
            System system(p);
            Dice dice(2);
            for (int repeat = 0; repeat < 200; ++repeat) {
                std::vector<double> y(static_cast<std::size_t>(system.size), 0.0);
                y[0] = dice.between(-3, 3);
                for (int i = 1; i < system.coordinates(); ++i)
                    y[static_cast<std::size_t>(i)] = dice.about_zero(0.01 / i);
                const double t = dice.between(0, 9);
                const double nothing[kMaxSize] = {};
                EXPECT_LE(system.gap_bound().lower_bound(system.drive(), t, 0, y.data(), nothing),
                          system.contact(t, y.data()).gap + 1e-15)
                    << name(kind);
            }
        }
}

}  // namespace
}  // namespace beamcam::sim::testing
