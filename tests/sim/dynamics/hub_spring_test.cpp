// The spring and damper of the hub against closed forms, and the methods against each other.
#include <cmath>

#include "sim/beam/modes.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

// J θ̈ = −kθ − cθ̇ from rest: e^(−γt)(cos wt + γ/w sin wt).
TEST(HubSpring, ARigidBeamIsADampedOscillator) {
    for (const Method method : {Method::automatic, Method::rk8, Method::cvode_bdf}) {
        Problem p = falling_beam(ModelKind::rigid);
        p.gravity = 0;
        p.hub.spring = {2, 0.3, 0.05};
        p.hub.inertia = 0.01;
        p.initial.angle = 0.8;
        p.solver.method = method;
        const double J = 0.01 + p.beam.line_density() * std::pow(p.beam.length, 3) / 3;
        const double decay = 0.05 / (2 * J), w = std::sqrt(2 / J - decay * decay);
        const std::vector<double> times{0.1, 0.77, 2.5};
        const std::vector<double> theta = series(p, "theta", times);
        for (std::size_t i = 0; i < times.size(); ++i) {
            const double t = times[i];
            const double exact = 0.3 + 0.5 * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
            EXPECT_NEAR(theta[i], exact, 1e-10) << name(method);
        }
        EXPECT_NEAR(series(p, "energy_spring", {0}).front(), 0.5 * 2 * 0.25, 1e-15);
        EXPECT_NEAR(series(p, "loss_hub", {30}).front(), 0.25, 1e-6) << "all of the energy";
    }
}

TEST(HubSpring, TheMethodsAgreeAndTheEnergyBalanceCloses) {
    for (const ModelKind model : {ModelKind::first_order, ModelKind::exact, ModelKind::second_order}) {
        Problem p;
        p.beam.model = model;
        p.beam.modes = 4;
        p.beam.damping_ratio = {0.01};
        p.hub.spring = {4, -0.3, 0.05};
        p.hub.inertia = 0.02;
        p.cam->speed = 5;
        p.initial.angle = 0.55;
        set_tolerance(p, 1e-10);
        Problem other = p;
        other.solver.method = Method::rk8;
        const std::vector<double> times{0.05, 0.12, 0.2};
        const std::vector<double> own = series(p, "theta", times), theirs = series(other, "theta", times);
        for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(own[i], theirs[i], 2e-7) << name(model);
        EXPECT_NEAR(series(p, "energy_residual", {0.2}).front(), 0, 1e-8) << name(model);
        EXPECT_NEAR(series(p, "loss_hub", {0.2}).front(), series(other, "loss_hub", {0.2}).front(), 1e-7);
    }
}

TEST(HubSpring, GivesTheHubAModeOfItsOwn) {
    Problem p = falling_beam(ModelKind::rigid);
    p.hub.spring = {7, 0.2, 0};
    p.hub.inertia = 0.03;
    const double J = 0.03 + p.beam.line_density() * std::pow(p.beam.length, 3) / 3;
    ASSERT_EQ(natural_modes(p, {}).size(), 1u);
    EXPECT_NEAR(natural_modes(p, {}).front().omega, std::sqrt(7 / J), 1e-12);
    p = falling_beam(ModelKind::first_order, Basis::cantilever, 6);
    p.hub.spring = {1e9, 0, 0};  // a clamp
    const std::vector<Mode> modes = natural_modes(p, {});
    ASSERT_EQ(modes.size(), 7u);
    EXPECT_NEAR(modes.front().omega, first_clamped_frequency(p.beam), 1e-4 * modes.front().omega);
}

// At rest on a cam that stands still: N x_c = M(θ) of weight and spring.
TEST(HubSpring, PressesARestingBeamOnTheCam) {
    Problem p = fixed_cam(ModelKind::rigid);
    p.hub.spring = {5, -1, 0};
    p.initial.shape = InitialShape::resting;
    const auto at_start = [&](const char* name) { return series(p, name, {0}).front(); };
    const double theta = at_start("theta"), weight = p.beam.line_density() * p.beam.length * p.gravity;
    const double moment = 5 * (theta + 1) + 0.5 * weight * p.beam.length * std::cos(theta);
    EXPECT_NEAR(at_start("contact_force") * at_start("contact_x"), moment, 1e-9 * moment);
}

// The same of a leaf without weight that the spring bends: its slope at the contact, 0.08, shortens the lever arm by half
// of its square.
TEST(HubSpring, BendsARestingLeafOnTheCam) {
    Problem p;
    p.hub.spring = {0.6, -0.7, 0};
    p.beam.length = 0.12;
    p.beam.section = Rectangle{0.012, 0.0009};
    p.beam.material = Material::steel;
    p.cam->centre = {0.075, 0};
    p.cam->radius = 0.02;
    p.cam->eccentricity = p.cam->speed = 0;
    p.contact.stiffness.reset();
    p.initial.shape = InitialShape::resting;
    p.gravity = 0;
    const auto at_start = [&](const char* name) { return series(p, name, {0}).front(); };
    EXPECT_GT(at_start("tip_deflection"), 0.005);
    const double moment = 0.6 * (at_start("theta") + 0.7);
    EXPECT_NEAR(at_start("contact_force") * at_start("contact_x"), moment, 0.0032 * moment);
}

// The hub turns at a constant rate: the drive gives what the spring takes.
TEST(HubSpring, ADriveOfGivenAngleBalancesIt) {
    for (const Method method : {Method::automatic, Method::rk8}) {
        Problem p = falling_beam(ModelKind::first_order);
        p.gravity = 0;
        p.hub.drive = ConstantSpeed{2};
        p.hub.spring = {3, 0.1, 0.2};
        p.initial.angle = 0.1;
        p.solver.method = method;
        EXPECT_NEAR(series(p, "energy_residual", {0.7}).front(), 0, 1e-9);
        const double bent = series(p, "energy_elastic", {0.7}).front();
        EXPECT_LT(bent, 1e-3);
        EXPECT_NEAR(series(p, "loss_hub", {0.7}).front(), 0.2 * 4 * 0.7, 1e-8);
    }
}

}  // namespace
}  // namespace beamcam::sim::testing
