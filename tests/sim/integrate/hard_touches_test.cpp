// Touches that a careless step would miss or step over: stiff ones after a force-free flight, and a disc that a long
// step could carry the beam through.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/run/simulate.hpp"

namespace beamcam::sim {
namespace {

// A rigid rod without gravity strikes a small disc at rest: nothing acts before, all at once after.
Problem strike() {
    Problem problem;
    problem.gravity = 0;
    problem.beam.model = ModelKind::rigid;
    problem.cam->centre = {0.5, 0};
    problem.cam->radius = 0.01;
    problem.cam->eccentricity = 0;
    problem.cam->speed = 0;
    problem.initial.angle = 0.35;
    problem.initial.angular_velocity = -2;
    problem.contact.damping = DampingLaw::none;
    return problem;
}

Result run(const Problem& problem, double end) {
    Request request;
    request.end_time = end;
    return simulate(problem, request);
}

TEST(HardTouch, AnElasticImpactReturnsTheSpeedAtEveryStiffnessAndTolerance) {
    for (const double stiffness : {1e6, 1e8, 1e10, 1e12})
        for (const double rtol : {1e-3, 1e-6, 1e-8}) {
            Problem problem = strike();
            problem.contact.stiffness = stiffness;
            problem.solver.rtol = rtol;
            const Result result = run(problem, 0.4);
            ASSERT_EQ(result.impacts.size(), 1u) << stiffness << " " << rtol;
            EXPECT_NEAR(result.impacts[0].restitution.value_or(0), 1, 0.3 * rtol + 2e-8) << stiffness << " " << rtol;
            EXPECT_GT(*result.impacts[0].force_peak, 0);
            EXPECT_LE(result.energy_residual_max, 10 * rtol * result.energy_scale);
        }
}

TEST(HardTouch, NoMethodStepsThroughTheDisc) {
    for (const Method method : {Method::automatic, Method::rk8, Method::cvode_adams, Method::cvode_bdf})
        for (const double speed : {-0.5, -2.0, -8.0}) {
            Problem problem = strike();
            problem.initial.angular_velocity = speed;
            problem.solver.method = method;
            EXPECT_GE(run(problem, 1).impacts.size(), 1u) << name(method) << " " << speed;
        }
}

// Without weight, torque and motion nothing accelerates: the touch is decided by the gap alone, which is open, closed
// or either by rounding.
TEST(HardTouch, ABeamAtRestNextToACamAtRestStaysThere) {
    for (const ContactModel model : {ContactModel::compliant, ContactModel::restitution})
        for (const double ulps : {-1.0, 0.0, 1.0}) {
            Problem problem = strike();
            problem.contact.model = model;
            const double touching = std::asin(0.01 / 0.5);
            problem.initial.angle = touching + ulps * 4e-18;
            problem.initial.angular_velocity = 0;
            const Result result = run(problem, 1);
            EXPECT_LT(result.counters.gap_evaluations, 1000) << name(model) << " " << ulps;
        }
}

TEST(HardTouch, ABeamThatAnImpactStopsWithoutWeightStaysOnTheCam) {
    Problem problem = strike();
    problem.contact.model = ContactModel::restitution;
    problem.contact.restitution = 0;
    const Result result = run(problem, 1);
    ASSERT_EQ(result.impacts.size(), 1u);
    EXPECT_LT(result.counters.gap_evaluations, 1000);
}

TEST(HardTouch, ALedgerThatDoesNotCloseIsTold) {
    Problem problem;
    problem.solver.method = Method::cvode_bdf;  // its local errors add up to some hundred times rtol here
    const Result result = run(problem, 1);
    ASSERT_GT(result.energy_residual_max, 10 * problem.solver.rtol * result.energy_scale);
    ASSERT_FALSE(result.warnings.empty());
    EXPECT_NE(result.warnings[0].find("energy balance"), std::string::npos);
}

}  // namespace
}  // namespace beamcam::sim
