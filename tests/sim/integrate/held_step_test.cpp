// Sustained impulsive contact in steps of the collocation, against the Runge–Kutta method and by its own properties.
#include <cmath>
#include <ostream>

#include "sim/base/numerics.hpp"
#include "sim/integrate/oscillator.hpp"
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
void strong_friction(Problem& p) {
    p.hub.radius = 0.1;
    p.contact.offset = 0.05;
    p.contact.friction = CoulombFriction{4, 1e-2};
}
void offset(Problem& p) { p.contact.offset = 0.0184; }
void damped(Problem& p) { p.beam.damping_ratio = {0.02}; }
void exact(Problem& p) { p.beam.model = ModelKind::exact; }
void hub(Problem& p) { p.hub = {0.1, 0.02, HarmonicTorque{0.2, 3, 0}}; }

INSTANTIATE_TEST_SUITE_P(All, HeldMotion,
                         ::testing::Values(Case{"Plain", plain}, Case{"Friction", friction}, Case{"Offset", offset},
                                           Case{"Damped", damped}, Case{"Exact", exact}, Case{"OnAHub", hub}),
                         [](const auto& given) { return given.param.name; });

// Without Baumgarte's terms and the correction of the rate at the end of each step the gap would drift.
TEST(HeldMotion, StaysOnTheCam) {
    Problem p = following({"", damped});
    EXPECT_GT(extremum(p, "gap", 5).min, -1e-11);
}

double steps(Problem p, int modes) {
    p.beam.modes = modes;
    return static_cast<double>(run(p, 1).counters.steps);
}

TEST(HeldMotion, TakesStepsThatDoNotFollowTheHighestMode) {
    for (const Case& c : {Case{"Damped", damped}, Case{"Plain", plain}}) {
        const Problem p = following(c);
        EXPECT_LT(steps(p, 24), 5 * steps(p, 3)) << c.name;  // whose highest frequency is a seventieth
    }
}

// Newton's equations contain the friction that the normal force causes.
TEST(HeldMotion, TakesNoShorterStepsUnderStrongFriction) {
    Problem rubbing = following({"", strong_friction}), smooth = rubbing;
    smooth.contact.friction = NoFriction{};
    EXPECT_LT(steps(rubbing, 3), 2 * steps(smooth, 3));
}

// No vibration grows from rounding until it limits the steps.
// After thousands of turns the instants of the nodes, and with them the velocity of the cam, are rounded by more than
// the motion itself. Rounding is no error that shorter steps would reduce.
TEST(HeldMotion, DoesNotStallAfterThousandsOfTurns) {
    SKIP_UNDER_SANITIZERS();
    for (const double speed : {60.0, 65.0})
        for (const double restitution : {0.4, 0.6}) {
            Problem p;
            p.beam.modes = 1;
            p.beam.damping_ratio = {0.02};
            p.hub = {0, 0.05, ConstantTorque{-1.5}};
            p.cam->speed = speed;
            p.cam->eccentricity = 0.002;
            p.cam->phase = 0.5;
            p.contact.model = ContactModel::restitution;
            p.contact.restitution = restitution;
            p.initial.angle = 0.46;
            const Result r = run(p, 400);
            EXPECT_LT(r.counters.steps, 100000) << speed << " " << restitution;
            EXPECT_GT(r.impacts.size(), 1000u);
        }
}

TEST(HeldMotion, TakesTheLongestStepsAtRest) {
    for (const Case& c : {Case{"Plain", plain}, Case{"Exact", exact}}) {
        Problem p = following(c);
        p.cam->speed = 0;
        for (const double rtol : {1e-4, 1e-6}) {
            set_tolerance(p, rtol);
            EXPECT_LT(steps(p, 8), 20) << c.name << " at " << rtol;
        }
    }
}

// ∫₀¹ ℓ_k f over b_k, by Gauss's rule in 100 parts.
template <class F>
double projection(int k, const F& f) {
    constexpr int kParts = 100;
    const Collocation& gauss = Collocation::get();
    double total = 0;
    for (int part = 0; part < kParts; ++part)
        for (int i = 0; i < kNodes; ++i) {
            const double s = (part + gauss.c[i]) / kParts;
            double p[kNodes], basis = 0;
            legendre(2 * s - 1, kNodes, p);
            for (std::size_t j = 0; j < kNodes; ++j) basis += gauss.legendre[j][k] * p[j];
            total += gauss.b[i] / kParts * basis * f(s);
        }
    return total / gauss.b[k];
}

TEST(ProjectedSteps, HaveTheNearestPolynomialsOfVibrations) {
    const double h = 0.01, q0 = 0.7;
    const Collocation& gauss = Collocation::get();
    const Lanes f = 5 + 3 * gauss.c - 2 * gauss.c * gauss.c * gauss.c;
    for (const double turn : {7.1, 14.0, 60.0, 300.0})
        for (const double ratio : {0.0, 0.05}) {
            const Oscillator o{turn / h, ratio * turn / h};
            const double w2 = o.omega * o.omega, v0 = -q0 * o.omega;
            const auto motion = [&](double s, double& q, double& v) {
                double r[kResponse];
                respond(o, s * h, r);
                q = (r[0] + 2 * o.gamma * r[1]) * q0 + r[1] * v0 +
                    w2 * (5 * r[2] + 3 / h * r[3] - 12 / (h * h * h) * r[5]);
                v = r[0] * v0 - w2 * r[1] * q0 + w2 * (5 * r[1] + 3 / h * r[2] - 12 / (h * h * h) * r[4]);
            };
            StepTable table, projected;
            table.build({o}, h);
            projected.build_projected({o}, table);
            const StepTable::Row& row = projected.rows[0];
            Lanes q = row.qq * q0 + row.qv * v0, v = row.vq * q0 + row.vv * v0;
            for (int l = 0; l < kNodes; ++l) {
                q += (w2 * f[l]) * row.q[static_cast<std::size_t>(l)];
                v += (w2 * f[l]) * row.v[static_cast<std::size_t>(l)];
            }
            for (int k = 0; k < kNodes; ++k) {
                double of_q, of_v;
                EXPECT_NEAR(q[k], projection(k, [&](double s) { return motion(s, of_q, of_v), of_q; }), 1e-11);
                EXPECT_NEAR(v[k], projection(k, [&](double s) { return motion(s, of_q, of_v), of_v; }),
                            1e-11 * o.omega);
            }
        }
}

}  // namespace
}  // namespace beamcam::sim::testing::held_motion
