// The start "resting": on the cam, in equilibrium with weight, torque and the inertia of moving along with it.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

// A rigid rod on a disc: θ(ψ) = atan2(B) + asin(R/|B|), x = √(|B|² − R²), N x = J ω² θ″(ψ) + ½mgL cos θ.
struct Following {
    double theta, x, force;
};

Following following(const Problem& p, double angle) {
    const auto theta = [&](double psi) {
        const Vec2 disc = p.cam->centre + p.cam->eccentricity * unit(psi);
        return std::atan2(disc.y, disc.x) + std::asin(p.cam->radius / norm(disc));
    };
    const double h = 2e-3, m = p.beam.line_density() * p.beam.length, j = m * p.beam.length * p.beam.length / 3;
    // Sixth order: 1/90, −3/20, 3/2, −49/18.
    const double bend =
        ((theta(angle + 3 * h) + theta(angle - 3 * h)) / 90 - 3 * (theta(angle + 2 * h) + theta(angle - 2 * h)) / 20 +
         3 * (theta(angle + h) + theta(angle - h)) / 2 - 49 * theta(angle) / 18) /
        (h * h);
    Following f;
    f.theta = theta(angle);
    const Vec2 disc = p.cam->centre + p.cam->eccentricity * unit(angle);
    f.x = std::sqrt(dot(disc, disc) - p.cam->radius * p.cam->radius);
    f.force = (j * p.cam->speed * p.cam->speed * bend + 0.5 * m * p.gravity * p.beam.length * std::cos(f.theta)) / f.x;
    return f;
}

Problem riding(ModelKind kind, double speed, double phase) {
    Problem p;
    p.beam.model = kind;
    p.cam->speed = speed;
    p.cam->phase = phase;
    p.initial.shape = InitialShape::resting;
    return p;
}

TEST(Resting, ForceOfAHeldRodIsThatOfWeightAndInertiaFromTheStart) {
    for (double speed : {-8.0, 1.0, 5.0})
        for (double phase : {0.0, 1.0, 3.0}) {
            Problem p = riding(ModelKind::rigid, speed, phase);
            p.contact.model = ContactModel::restitution;
            const std::vector<double> times{0, 0.01, 0.1};
            const std::vector<double> force = series(p, "contact_force", times);
            for (std::size_t k = 0; k < times.size(); ++k) {
                const double closed = following(p, phase - speed * times[k]).force;
                EXPECT_NEAR(force[k], closed, 1e-8 * closed) << speed << " " << phase << " " << times[k];
            }
        }
}

TEST(Resting, ATorqueThatLiftsTheBeamSoonAfterTheStartDoesNotChangeTheStart) {
    Problem p = riding(ModelKind::rigid, 5, 1);
    p.contact.model = ContactModel::restitution;
    const std::vector<double> free = series(p, "theta_dot", {0});
    p.hub.drive = TorqueTable{{0, 1e-4, 1}, {0, 100, 100}};
    EXPECT_NEAR(series(p, "theta_dot", {0})[0], free[0], 1e-9 * std::fabs(free[0]));
    EXPECT_GT(series(p, "gap", {0.01})[0], 0);
}

TEST(Resting, UnderATorqueWithoutGravityTheForceBalancesTheTorqueAndStaysConstant) {
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order, ModelKind::exact})
        for (const ContactModel contact : {ContactModel::restitution, ContactModel::compliant}) {
            Problem p = riding(kind, 0, 0);
            p.beam.modes = 3;
            p.gravity = 0;
            p.hub.drive = ConstantTorque{-2};
            p.contact.model = contact;
            const std::vector<double> force = series(p, "contact_force", {0, 0.001, 0.02});
            const double lever = following(p, 0).x;  // of the straight beam
            EXPECT_NEAR(force[0], 2 / lever, 0.01 * force[0]) << name(kind);
            for (const double later : force) EXPECT_NEAR(later, force[0], 1e-7 * force[0]) << name(kind);
        }
}

// A spring-steel reed, whose static penetration of 10⁻¹⁰ m is far below its deflection.
TEST(Resting, AThinBeamOnAStiffCamHasItsEquilibrium) {
    for (const ModelKind kind : {ModelKind::rigid, ModelKind::first_order, ModelKind::exact})
        for (double at = 0.1; at < 0.15; at += 0.005) {
            Problem p;
            p.beam.length = 0.18;
            p.beam.section = Rectangle{0.015, 0.0005};
            p.beam.material = Material::steel;
            p.beam.model = kind;
            p.cam->centre = {at, -0.015};
            p.cam->radius = 0.02;
            p.cam->eccentricity = p.cam->speed = 0;
            p.contact.stiffness.reset();
            p.initial.shape = InitialShape::resting;
            const std::vector<double> force = series(p, "contact_force", {0, 0.001, 0.01});
            const double weight = p.beam.line_density() * p.beam.length * p.gravity;
            EXPECT_NEAR(force[0], 0.5 * p.beam.length / at * weight, 0.05 * weight) << name(kind) << " " << at;
            for (const double later : force) EXPECT_NEAR(later, force[0], 1e-4 * force[0]) << name(kind) << " " << at;
        }
}

// N x_c = ½mgL cos θ, up to the rounding of the gap, n 10⁻¹⁵ m/δ of the force.
TEST(Resting, StiffContactsHaveTheirEquilibrium) {
    for (const double stiffness : {1e6, 1e8, 1e10, 1e12})
        for (const double exponent : {1.0, 1.2, 1.5}) {
            Problem p = riding(ModelKind::rigid, 0, 0);
            p.contact.stiffness = stiffness;
            p.contact.exponent = exponent;
            p.contact.damping = DampingLaw::none;
            Request request;
            request.end_time = 0.01;
            request.tables.push_back(
                {{0, 0.01}, {channel("contact_force"), channel("contact_x"), channel("theta"), channel("gap")}});
            const auto values = simulate(p, request).tables[0].values;
            const double weight = p.beam.line_density() * p.beam.length * p.gravity, depth = -values[3][0];
            for (const std::size_t row : {0, 1})
                EXPECT_NEAR(values[0][row] * values[1][row], 0.5 * weight * p.beam.length * std::cos(values[2][row]),
                            weight * (1e-8 + exponent * 1e-14 / depth))
                    << stiffness << " " << exponent;
        }
}

TEST(Resting, ACamThatLeavesTheBeamBehindIsReported) {
    for (const ContactModel contact : {ContactModel::restitution, ContactModel::compliant})
        for (const double speed : {5.0, 60.0})
            for (const double phase : {0.0, 1.5, 3.0}) {
                Problem p = riding(ModelKind::rigid, speed, phase);
                p.contact.model = contact;
                const std::vector<std::string> warnings = run(p, 1e-4).warnings;
                const bool reported = std::any_of(warnings.begin(), warnings.end(), [](const std::string& w) {
                    return w.find("follows the turning cam") != std::string::npos;
                });
                EXPECT_EQ(reported, following(p, phase).force < 0) << speed << " " << phase;
            }
}

TEST(Resting, CompliantContactStartsPressedByTheSameForceAndDoesNotRing) {
    for (double speed : {1.0, 5.0}) {
        Problem p = riding(ModelKind::rigid, speed, 1);
        p.contact.stiffness = 1e11;
        p.contact.damping = DampingLaw::none;  // ringing would stay
        std::vector<double> times;
        for (int k = 0; k <= 50; ++k) times.push_back(1e-4 * k);
        const std::vector<double> force = series(p, "contact_force", times);
        for (std::size_t k = 0; k < times.size(); ++k) {
            // Penetration lowers the rod by δ = (N/K)^⅔ = 1e-7 m: as much of R and D.
            const double closed = following(p, 1 - speed * times[k]).force;
            EXPECT_NEAR(force[k], closed, 5e-6 * closed) << speed << " at " << times[k];
        }
    }
}

TEST(Resting, FlexibleBeamOnATurningCamDoesNotRing) {
    // Without inertia forces in the initial shape the force would oscillate by a relative 2e-3.
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order, ModelKind::exact}) {
        Problem p = riding(kind, 5, 0);
        p.contact.damping = DampingLaw::none;
        std::vector<double> times;
        for (int k = 0; k <= 40; ++k) times.push_back(5e-4 * k);
        const std::vector<double> force = series(p, "contact_force", times);
        for (std::size_t k = 1; k + 1 < times.size(); ++k)
            EXPECT_NEAR(force[k - 1] - 2 * force[k] + force[k + 1], 0, 3e-6 * force[k])
                << name(kind) << " " << times[k];
    }
}

// What the iteration left of a rate once rang on as a force that steps had to follow: thousands of them a second, and
// more at some looser tolerances than at tighter ones.
TEST(Resting, LastingContactIsSteppedOverAtEveryTolerance) {
    for (const int modes : {2, 3, 8})
        for (const double rtol : {1e-6, 1e-8, 1e-10, 1e-12}) {
            Problem p = riding(ModelKind::first_order, 1, 0);
            p.beam.modes = modes;
            p.solver.rtol = rtol;
            const double end = 10, turned = System(p).highest_frequency() * end;  // [rad]
            const Counters counters = run(p, end).counters;
            EXPECT_LT(12.0 * static_cast<double>(counters.steps + counters.rejected), turned) << modes << " " << rtol;
        }
}

// The same after impacts, whose δ̇₋ makes the contact's damping weaker.
TEST(Resting, LastingContactAfterImpactsIsSteppedOver) {
    SKIP_UNDER_SANITIZERS();
    const auto tried = [](int modes, double rtol) {
        Problem p;
        p.beam.modes = modes;
        p.solver.rtol = rtol;
        const Counters counters = run(p, 40).counters;
        return counters.steps + counters.rejected;
    };
    for (const int modes : {3, 4}) {
        const long few = tried(modes, 1e-10);
        for (const double rtol : {1e-7, 1e-8, 1e-9}) EXPECT_LT(tried(modes, rtol), 1.3 * few) << modes << " " << rtol;
    }
}

// A step whose iteration loses the contact is tried again, shorter, from where the contact is.
TEST(Resting, ALostContactIsFoundAgainByShorterSteps) {
    Problem p;
    p.initial.shape = InitialShape::resting;
    p.cam->speed = 5;
    p.solver.rtol = 1e-8;
    const Counters counters = run(p, 20).counters;
    EXPECT_LT(counters.steps, 5000);
}

TEST(Resting, CarriesTheTorqueOfTheHub) {
    Problem p = riding(ModelKind::rigid, 0, 0);
    p.contact.model = ContactModel::restitution;
    p.hub.drive = ConstantTorque{-0.3};
    const Following free = following(p, 0);
    EXPECT_NEAR(series(p, "contact_force", {0})[0], free.force + 0.3 / free.x, 1e-9);
    // With an opposite torque and no weight the beam rests on the other side of the cam.
    p.hub.drive = ConstantTorque{+5};
    p.contact.model = ContactModel::compliant;
    p.cam->centre = {0, 0.25};
    p.gravity = 0;
    const std::vector<double> theta = series(p, "theta", {0, 0.05});
    EXPECT_LT(theta[0], std::numbers::pi / 2);
    EXPECT_NEAR(theta[0], theta[1], 1e-9);
}

TEST(Resting, LiesOnTopOfACamOnEitherSideOfTheHub) {
    Problem right = riding(ModelKind::first_order, 0, 0), left = right;
    left.cam->centre = {-0.25, 0};
    left.cam->phase = std::numbers::pi;
    const double a = series(right, "theta", {0.1})[0], b = series(left, "theta", {0.1})[0];
    EXPECT_NEAR(a + b, std::numbers::pi, 1e-9);
    EXPECT_NEAR(series(right, "contact_force", {0.1})[0], series(left, "contact_force", {0.1})[0], 1e-6);
}

TEST(Resting, LiesUnderTheCamWhenPushedUp) {
    Problem p = riding(ModelKind::first_order, 0, 0);
    p.gravity = 0;
    p.hub.drive = ConstantTorque{0.3};
    EXPECT_LT(series(p, "theta", {0.05})[0], 0);
    p.hub.drive = FreeDrive{};
    p.gravity = -9.81;
    EXPECT_LT(series(p, "theta", {0.05})[0], 0);
}

TEST(Resting, OnACamTooFastToFollowIsLeftBehindAtOnce) {
    for (const ContactModel model : {ContactModel::compliant, ContactModel::restitution}) {
        Problem p = riding(ModelKind::rigid, 40, 2);
        p.contact.model = model;
        ASSERT_LT(following(p, 2).force, 0);
        const Result r = run(p, 0.02);
        ASSERT_FALSE(r.impacts.empty());
        ASSERT_TRUE(r.impacts[0].t_end.has_value());
        EXPECT_LT(*r.impacts[0].t_end, 1e-3);
    }
}

}  // namespace
}  // namespace beamcam::sim::testing
