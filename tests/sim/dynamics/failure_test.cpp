// The message of a failed run names the cause, the numbers and a remedy, and the remedy works.
#include "sim/dynamics/failure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

// The message of the failed run; empty if it succeeds.
std::string message_of(const Problem& p, double end) {
    try {
        run(p, end);
    } catch (const SolverError& error) {
        EXPECT_GT(error.last_time, 0);
        EXPECT_EQ(error.partials.at(0).end_time, error.last_time);
        return error.what();
    }
    return "";
}

TEST(Failure, LargeDeflectionsOfAModalModelNameTheModelExact) {
    Problem p;
    p.gravity = 1e6;
    const std::string message = message_of(p, 0.01);
    EXPECT_THAT(message, AllOf(HasSubstr("has bent through"), HasSubstr("gravity is 1e+06"), HasSubstr("\"exact\"")));
    // Also before the contact, where the inertia is lost first.
    p.initial.angle = 0.44;
    p.initial.angular_velocity = -2;
    EXPECT_THAT(message_of(p, 0.01), AllOf(HasSubstr("has bent through"), HasSubstr("\"exact\"")));
}

TEST(Failure, ALightHubWithManyShapesNamesTheRemedies) {
    SKIP_UNDER_SANITIZERS();
    Problem p;
    p.beam.basis = Basis::cantilever;
    p.beam.modes = 12;
    EXPECT_THAT(message_of(p, 0.6),
                AllOf(HasSubstr("positive inertia"), HasSubstr("hub-beam"), HasSubstr("hub.inertia")));
}

TEST(Failure, AVerySmallCamNamesASufficientStiffness) {
    Problem p;
    p.cam->radius = 1e-6;
    p.cam->eccentricity = p.cam->speed = 0;
    const std::string message = message_of(p, 0.4);
    EXPECT_THAT(message, AllOf(HasSubstr("cam's radius 1e-06 m"), HasSubstr("m deep"), HasSubstr("restitution")));
    const std::string before = "contact.stiffness of ";
    const std::size_t at = message.find(before);
    ASSERT_NE(at, std::string::npos) << message;
    p.contact.stiffness = std::strtod(message.c_str() + at + before.size(), nullptr);
    EXPECT_GT(*p.contact.stiffness, 1e12);
    EXPECT_EQ(message_of(p, 0.4), "");
}

TEST(Failure, ABeamPressedThroughTheCamByItsDriveNamesTheDrive) {
    Problem p;
    p.hub.drive = ConstantSpeed{-50};
    p.beam.modes = 1;
    p.beam.youngs_modulus = 1e14;
    EXPECT_THAT(message_of(p, 0.2),
                AllOf(HasSubstr("pressed through"), HasSubstr("which no impact does"), HasSubstr("change hub.drive")));
}

TEST(Failure, RotationThatDestabilizesAModelIsNamed) {
    Problem p;
    p.cam.reset();
    p.beam.youngs_modulus = 1e9;
    p.hub.drive = ConstantSpeed{-30};
    p.beam.model = ModelKind::paper;
    EXPECT_THAT(message_of(p, 100),
                AllOf(HasSubstr("L cos θ"), HasSubstr("30 rad/s"), HasSubstr("22.4 rad/s"), HasSubstr("first-order")));
    p.beam.model = ModelKind::zeroth_order;
    EXPECT_THAT(message_of(p, 100), AllOf(HasSubstr("no centrifugal stiffening"), HasSubstr("first-order")));
    p.beam.model = ModelKind::first_order;
    EXPECT_EQ(message_of(p, 1), "");
}

TEST(Failure, VanishingStepsWithoutInertiaNameTheInertia) {
    Problem p;  // hardly any inertia left beside these shapes: the torque turns them fast at once
    p.beam.model = ModelKind::paper;
    p.beam.modes = 8;
    p.hub.drive = ConstantTorque{-100};
    p.solver.rtol = 1e-6;
    EXPECT_THAT(message_of(p, 0.2), AllOf(HasSubstr("positive inertia"), HasSubstr("fewer modes")));
}

TEST(Failure, AnExhaustedBudgetNamesTheLimitsOfTheStepSize) {
    Problem p;
    p.beam.modes = 40;
    p.contact.stiffness = 1e12;
    p.solver.max_steps = 3000;
    p.solver.method = Method::rk8;
    EXPECT_THAT(message_of(p, 0.5), AllOf(HasSubstr("budget of 3000 steps"), HasSubstr("40 modes"),
                                          HasSubstr("1e+12 N/m^1.5"), HasSubstr("solver.max_steps")));
    p.beam.modes = 2;
    p.beam.damping_ratio = {1000};
    EXPECT_THAT(message_of(p, 0.5), AllOf(HasSubstr("damping 1e+03 times the critical"), HasSubstr("cvode-bdf")));
}

TEST(Failure, AProjectedExcessOfTheBudgetStopsTheRunEarly) {
    SKIP_UNDER_SANITIZERS();
    Problem p;
    p.cam.reset();
    p.beam.modes = 1;
    p.beam.model = ModelKind::second_order;
    p.beam.youngs_modulus = 1e25;
    p.solver.method = Method::rk8;
    p.solver.max_steps = 1'000'000;
    EXPECT_THAT(message_of(p, 1e3), AllOf(HasSubstr("at the current step size"), HasSubstr("its budget of 1000000"),
                                          HasSubstr("1 mode up to")));
}

// The face lies so far from the centre line that friction turns the beam into the cam, in both models of contact and
// for each kind of friction.
TEST(Failure, FrictionThatLocksTheContactIsNamedAtOnce) {
    Problem p;
    p.beam.model = ModelKind::rigid;
    p.cam->centre = {0.4, -0.2};
    p.cam->radius = 0.1;
    p.cam->eccentricity = 0;
    p.cam->speed = -20;
    p.contact.restitution = 0.9;
    p.contact.offset = 0.3;
    p.initial.angle = 1.2;
    for (const ContactModel model : {ContactModel::compliant, ContactModel::restitution})
        for (const double coefficient : {0.5, 0.8, 1.2, 3.0})
            for (const bool bristle : {false, true}) {
                SCOPED_TRACE(::testing::Message() << name(model) << " " << coefficient << " " << bristle);
                p.contact.model = model;
                if (bristle)
                    p.contact.friction = StickSlipFriction{coefficient, {}, {}};
                else
                    p.contact.friction = CoulombFriction{coefficient};
                const std::string message = message_of(p, 1.5);
                if (coefficient < 0.6)
                    EXPECT_EQ(message, "");
                else
                    EXPECT_NE(message.find("friction locks the beam to the cam"), std::string::npos) << message;
            }
}

TEST(Failure, AToleranceThatNoStepMeetsHasAClearMessage) {
    for (const Method method : {Method::automatic, Method::rk8, Method::cvode_adams}) {
        Problem p;
        p.cam.reset();
        p.gravity = 1e30;
        p.solver.method = method;
        try {
            run(p, 1);
            ADD_FAILURE() << name(method) << " ended";
        } catch (const SolverError& error) {
            EXPECT_THAT(error.what(), AnyOf(HasSubstr("no step, however short"), HasSubstr("budget"),
                                            HasSubstr("beyond all numbers"), HasSubstr("has bent through")))
                << name(method);
        }
    }
}

// y′ = 1 up to t = 1, NaN after it.
struct Wall final : Ode {
    Wall() { size = controlled = 1; }
    void rhs(double t, const double*, double* dy) override { dy[0] = t < 1 ? 1 : std::nan(""); }
};

TEST(Failure, OfSundialsKeepsItsFlagAndItsCause) {
    const auto message = [](Method method, double from, double tolerance) -> std::string {
        Wall wall;
        const std::unique_ptr<Integrator> integrator = make_sundials(method, wall, tolerance, tolerance);
        const double start[] = {1};
        try {
            integrator->start(from, start);
            integrator->step();
        } catch (const StepFailure& failure) {
            return failure.what();
        }
        return "";
    };
    for (const Method method : {Method::cvode_adams, Method::cvode_bdf})
        EXPECT_THAT(message(method, 2, 1e-8),
                    AllOf(HasSubstr("beyond all numbers"), HasSubstr("CVODE: CV_"), HasSubstr("RHSFUNC")))
            << name(method);
    EXPECT_THAT(message(Method::cvode_adams, 0, 1e-18),
                AllOf(HasSubstr("more digits"), HasSubstr("CVODE: CV_TOO_MUCH_ACC")));
}

TEST(Failure, InOtherTermsKeepsTheIntegratorsWords) {
    Problem p;
    System system(p);
    std::vector<double> y(static_cast<std::size_t>(system.size), 0.0);
    y[1] = 0.5;  // far beyond small deflections
    const std::string message =
        explain({Stop::method, "the integrator gave up (CVODE: CV_ERR_FAILURE)", 0.1, 1e-3, 0}, system, y.data());
    EXPECT_THAT(message, AllOf(HasSubstr("has bent through"), HasSubstr("CVODE: CV_ERR_FAILURE")));
}

TEST(Failure, OfTheInertiaInAHeldContactIsNotAVanishedForce) {
    Problem p;  // clamped shapes with a light hub, held on the cam
    p.beam.basis = Basis::cantilever;
    p.beam.modes = 12;
    System system(p);
    Phase held;
    held.touching = held.held = true;
    system.set_phase(held);
    std::vector<double> y(static_cast<std::size_t>(system.size), 0.0);
    y[0] = 0.3;
    for (int i = 1; i < system.coordinates(); ++i) y[static_cast<std::size_t>(i)] = 0.02;
    ContactState c;
    c.x = 0.2;
    EXPECT_THROW(system.contact(0, y.data()), InertiaLost);
    EXPECT_THROW(system.free_gap_acceleration(0, y.data()), InertiaLost);
    EXPECT_THROW(system.compliance(0, y.data(), c), InertiaLost);
    EXPECT_THROW(system.apply_impact(0, y.data(), c, {}), InertiaLost);
}

TEST(Failure, NoLawIsBlamedForRoundingOfAHeldContact) {
    Problem p;
    p.contact.model = ContactModel::restitution;
    p.initial.shape = InitialShape::resting;
    p.cam->speed = 5;
    p.hub.drive = ConstantTorque{-500};
    for (const std::string& w : run(p, 0.1).warnings) EXPECT_THAT(w, Not(HasSubstr("impact law")));
}

}  // namespace
}  // namespace beamcam::sim::testing
