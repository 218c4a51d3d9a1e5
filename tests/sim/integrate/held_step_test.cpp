// Sustained impulsive contact in steps of the collocation, against the Runge–Kutta method and by its own properties.
#include <cmath>
#include <ostream>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing::held_motion {
namespace {

struct Case {
    const char* name;
    void (*change)(Problem&);
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

// A beam that rests on the cam, and vibrates as it follows it.
Problem following(const Case& c) {
    Problem p;
    p.beam.modes = 3;
    p.cam->speed = 1;
    p.contact.model = ContactModel::restitution;
    p.contact.restitution = 0;
    p.initial.shape = InitialShape::resting;
    c.change(p);
    return p;
}

class HeldMotion : public ::testing::TestWithParam<Case> {};

TEST_P(HeldMotion, IsThatOfTheRungeKuttaMethod) {
    Problem p = following(GetParam());
    ASSERT_TRUE(validate(p).empty());
    std::vector<double> times;
    for (double t = 0; t < 0.6; t += 3.1e-3) times.push_back(t);
    Request request;
    request.tables.push_back({times,
                              {channel("theta"), channel("theta_dot"), channel("q1"), channel("contact_force"),
                               channel("friction_force"), channel("loss_friction"), channel("work_cam")}});
    set_tolerance(p, 1e-8);
    const Result fast = simulate(p, {&request, 1}).front();
    p.solver.method = Method::rk8;
    set_tolerance(p, 1e-12);
    const Result slow = simulate(p, {&request, 1}).front();

    ASSERT_EQ(fast.steps_by_method.size(), 1u) << "not all steps are of the collocation";
    ASSERT_EQ(fast.impacts.size(), 1u);
    EXPECT_EQ(fast.impacts[0].t_end, slow.impacts[0].t_end);
    for (std::size_t i = 0; i < fast.tables[0].values.size(); ++i) {
        const std::vector<double>&a = fast.tables[0].values[i], &b = slow.tables[0].values[i];
        double size = 1e-9;
        for (const double value : b) size = std::max(size, std::fabs(value));
        for (std::size_t row = 0; row < times.size(); ++row)
            ASSERT_NEAR(a[row], b[row], 1e-6 * size) << i << " at " << times[row];
    }
    EXPECT_LT(fast.energy_residual_max, 1e-8 * fast.energy_scale);
}

void plain(Problem&) {}
void friction(Problem& p) { p.contact.friction = CoulombFriction{0.3, 1e-2}; }
void offset(Problem& p) { p.contact.offset = 0.0184; }
void damped(Problem& p) { p.beam.damping_ratio = {0.02}; }
void second_order(Problem& p) { p.beam.model = ModelKind::second_order; }
void exact(Problem& p) { p.beam.model = ModelKind::exact; }
void clamped(Problem& p) { p.beam.basis = Basis::cantilever; }
void hub(Problem& p) { p.hub = {0.1, 0.02, HarmonicTorque{0.2, 3, 0}}; }

INSTANTIATE_TEST_SUITE_P(All, HeldMotion,
                         ::testing::Values(Case{"Plain", plain}, Case{"Friction", friction}, Case{"Offset", offset},
                                           Case{"Damped", damped}, Case{"SecondOrder", second_order},
                                           Case{"Exact", exact}, Case{"Clamped", clamped}, Case{"OnAHub", hub}),
                         [](const auto& given) { return given.param.name; });

// Without Baumgarte's terms and the correction of the rate at the end of each step the gap would drift.
TEST(HeldMotion, StaysOnTheCam) {
    Problem p = following({"", damped});
    EXPECT_GT(extremum(p, "gap", 5).min, -1e-11);
}

TEST(HeldMotion, TakesStepsThatDoNotFollowTheHighestMode) {
    const auto steps = [](int modes) {
        Problem p = following({"", damped});
        p.beam.modes = modes;
        return static_cast<double>(run(p, 1).counters.steps);
    };
    EXPECT_LT(steps(24), 5 * steps(3));  // whose highest frequency is a seventieth
}

}  // namespace
}  // namespace beamcam::sim::testing::held_motion
