// Contact geometry, forces and the balance of powers, at random states.
#include "sim/dynamics/system.hpp"

#include <cmath>

#include "sim/base/numerics.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

struct ContactCase {
    ModelKind model;
    Basis basis;
    double radius, offset;
    int friction;  // 0 none, 1 coulomb, 2 stick-slip
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
    if (c.friction == 1) p.contact.friction = CoulombFriction{0.3, 0.1};
    if (c.friction == 2) p.contact.friction = StickSlipFriction{0.3, 0.4, 2e4};
    return p;
}

std::string contact_case_name(const ::testing::TestParamInfo<ContactCase>& info) {
    const ContactCase& c = info.param;
    const char* friction[] = {"Frictionless", "Coulomb", "StickSlip"};
    return label(name(c.model)) + label(name(c.basis)) + (c.radius != 0 ? "Radius" : "") +
           (c.offset > 0 ? "Offset" : "") + friction[c.friction];
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

class Contact_ : public ::testing::TestWithParam<ContactCase> {};

TEST_P(Contact_, FootIsTheNearestPoint) {
    const Problem p = contact_problem(GetParam());
    System system(p);
    Dice dice(11);
    for (int repeat = 0; repeat < 6; ++repeat) {
        const std::vector<double> y = pressed_state(system, dice, dice.between(-0.1, 0.001), 0.3);
        const ContactState c = system.contact(0.3, y.data());
        const Vec2 disc = system.cam(0.3).disc;
        double nearest = 1e9;
        BeamPoint point;
        for (int i = 0; i <= 4000; ++i) {
            system.model().point(p.beam.length * i / 4000, point);
            nearest = std::min(nearest, norm(point.r - disc));
        }
        const double distance = c.gap + p.cam->radius + system.offset();
        EXPECT_LE(distance, nearest + 1e-12);
        EXPECT_NEAR(distance, nearest, 1e-6);  // half a grid step squared over twice the distance
        system.model().point(c.x, point);
        if (!c.at_end) {
            EXPECT_NEAR(dot(point.r1, point.r - disc), 0, 1e-12);
        }
        EXPECT_NEAR(norm(c.normal), 1, 1e-14);
        EXPECT_NEAR(dot(c.normal, c.tangent), 0, 1e-15);
        EXPECT_NEAR(cross(c.tangent, c.normal), 1, 1e-14);  // t is n turned by −90°
    }
}

TEST_P(Contact_, GapRateIsTheDerivativeOfTheGap) {
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

TEST_P(Contact_, PowerOnTheBeamIsWorkOfTheCamLessWhatTheContactTakes) {
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
        const double* ledger = dy.data() + system.controlled;
        const double size = c.force * (std::fabs(c.gap_rate) + 1) + std::fabs(c.friction) * (std::fabs(c.slip) + 1);
        EXPECT_GT(c.force, 0);
        EXPECT_NEAR(power, ledger[kWorkCam] - ledger[kNormalWork] - ledger[kFrictionWork], 1e-13 * size);
    }
}

// The total of the energy balance along the flow has a zero rate.
TEST_P(Contact_, LedgerIsConstantAlongTheFlow) {
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
            return balance.total();
        };
        const double h = 1e-7, drift = scalar_slope_at_zero(total, h);
        const ContactState c = system.contact(0.1, y.data());
        const double power = std::fabs(c.force) * (1 + std::fabs(c.gap_rate)) + std::fabs(c.friction * c.slip) + 10;
        EXPECT_NEAR(drift, 0, 1e-6 * power) << "grip " << repeat % 3;
    }
}

INSTANTIATE_TEST_SUITE_P(Every, Contact_,
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
                                           ContactCase{ModelKind::exact, Basis::automatic, -0.05, 0.0184, 2}),
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
    const CamPose pose = system.cam(0.25);
    EXPECT_NEAR(pose.angle, 0.3 - 0.5, 1e-16);
    EXPECT_NEAR(pose.disc.x, 0.25 + 0.02 * std::cos(-0.2), 1e-16);
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
        for (const double radius : {-0.1, 0.0, 0.2}) {
            Problem p;
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
