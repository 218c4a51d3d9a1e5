// Stick-slip friction in steps of the collocation: the elimination of the bristle against the complete equations, its
// deflection against closed forms, and whole motions against the Runge–Kutta method.
#include "sim/integrate/friction_step.hpp"

#include <Eigen/LU>
#include <cmath>
#include <ostream>

#include "sim/run/run.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

Lanes random_lanes(Dice& dice) {
    Lanes out;
    for (int k = 0; k < kNodes; ++k) out[k] = dice.about_zero(1);
    return out;
}

NodalMatrix random_matrix(Dice& dice) {
    NodalMatrix out;
    for (Lanes& column : out) column = random_lanes(dice);
    return out;
}

FrictionLaw bristle_law() {
    FrictionLaw law;
    law.kinetic = law.limit = 0.4;
    law.bristle = true;
    law.stiffness = 0.7;
    return law;
}

// Newton's equations of a linear normal force N = −aδ − bδ̇ and of friction, all together.
TEST(FrictionStep, EliminationSolvesTheCompleteEquations) {
    Dice dice(3);
    FrictionLaw coulomb;
    coulomb.kinetic = coulomb.limit = 0.4;
    coulomb.slip_speed = 0.6;
    const std::pair<FrictionLaw, FrictionState> cases[] = {{bristle_law(), FrictionState::stick},
                                                           {bristle_law(), FrictionState::slide_plus},
                                                           {bristle_law(), FrictionState::slide_minus},
                                                           {coulomb, FrictionState::stick}};
    for (const auto& [law, state] : cases) {
        const double a = 0.8, b = 0.2;
        const NodalCompliance across{random_matrix(dice), random_matrix(dice)},
            along{random_matrix(dice), random_matrix(dice)}, normal{random_matrix(dice), random_matrix(dice)};
        const Lanes force = random_lanes(dice), slip = random_lanes(dice), residual = random_lanes(dice);
        Lanes friction = random_lanes(dice);
        if (!law.bristle)
            for (int k = 0; k < kNodes; ++k) friction[k] = law.coulomb(force[k], slip[k]);
        FrictionStep step(law);
        step.begin(state, 0.1, 0.5, normal, across, along);
        ASSERT_TRUE(step.linearize(force, friction, slip));
        NodalMatrix matrix;
        for (std::size_t l = 0; l < kNodes; ++l) {
            matrix[l] = a * step.gap().value[l] + b * step.gap().rate[l];
            matrix[l][static_cast<int>(l)] += 1;
        }
        Lanes change = residual - (a * step.gap_ahead() + b * step.gap_rate_ahead());
        ASSERT_TRUE(solve_dense(matrix, {&change, 1}));
        const Lanes friction_change = step.change(change);

        Lanes now;  // friction at this slip and normal force
        Lanes bristle_rate;
        step.settle(force, slip, now, bristle_rate);
        const Lanes first = change + (a * (normal.value * change) + b * (normal.rate * change)) +
                            (a * (across.value * friction_change) + b * (across.rate * friction_change));
        Lanes second = friction_change;
        const Lanes slipped = across.rate * change + along.rate * friction_change;
        if (law.bristle && state == FrictionState::stick)
            second += law.stiffness * (across.value * change + along.value * friction_change);
        for (int k = 0; k < kNodes; ++k) {
            if (!law.bristle) {  // by differences of its law
                const double d = 1e-6;
                const auto at = [&](double share) {
                    return law.coulomb(force[k] + share * d * change[k], slip[k] + share * d * slipped[k]);
                };
                second[k] -= (at(1) - at(-1)) / (2 * d);
            } else if (state != FrictionState::stick) {
                second[k] += FrictionLaw::sign(state) * law.kinetic * change[k];
            }
            EXPECT_NEAR(first[k], residual[k], 1e-11) << k;
            EXPECT_NEAR(second[k], now[k] - friction[k], law.bristle ? 1e-11 : 1e-8) << k;
        }
    }
}

// v + cμN tanh(v/v_s) = v_t − cF_t has one solution, which Newton's method from v_t would miss.
TEST(FrictionStep, CoulombsLawIsTakenWhereItGivesTheForceThatTheSlipYieldsTo) {
    FrictionLaw law;
    law.kinetic = law.limit = 0.5;
    law.slip_speed = 1e-6;
    for (const double slip : {0.0, 1e-9, -3e-6, 0.2, -40.0})
        for (const double friction : {0.0, 1.0, -2.0})
            for (const double mobility : {1e-6, 1e-3, 10.0}) {
                const double v = law.slip_near(4, friction, slip, mobility);
                EXPECT_NEAR(v - mobility * law.coulomb(4, v), slip - mobility * friction,
                            1e-12 * (std::fabs(slip) + mobility));
            }
    EXPECT_EQ(law.slip_near(0, 0, 0.3, 1), 0.3);
}

TEST(FrictionStep, StoresTheWorkOfStick) {
    Dice dice(5);
    const FrictionLaw law = bristle_law();
    FrictionStep bristle(law);
    const double h = 0.5, z0 = 0.1;
    bristle.begin(FrictionState::stick, z0, h, {}, {}, {});
    const Lanes slip = random_lanes(dice);
    Lanes friction, rate;
    bristle.settle(random_lanes(dice), slip, friction, rate);
    const Lanes& b = Collocation::get().b;
    const double z1 = z0 + h * sum(b * rate);
    EXPECT_NEAR(-h * sum(b * friction * slip), 0.5 * law.stiffness * (z1 * z1 - z0 * z0), 1e-15);
}

// ---- motions -------------------------------------------------------------------------------------

// The changes of the friction's state. Those closer than `kOneInstant` count as one.
class FrictionChanges final : public Observer {
  public:
    struct Change {
        double t;
        FrictionState state;
    };
    double end() const override { return 0; }
    void resume(double t, const std::vector<double>&, const Phase& phase) override {
        if (!phase.touching) return;
        while (!all.empty() && t - all.back().t < kOneInstant) all.pop_back();
        if (all.empty() || all.back().state != phase.friction) all.push_back({t, phase.friction});
    }
    void step(const SegmentInterval&) override {}
    bool done() const override { return false; }
    std::vector<Change> all;

  private:
    static constexpr double kOneInstant = 1e-9;
};

struct Motion {
    Result result;
    std::vector<FrictionChanges::Change> changes;
};

Motion motion(const Problem& p, const std::vector<double>& times) {
    FrictionChanges changes;
    Request request;
    request.tables.push_back({times,
                              {channel("theta"), channel("theta_dot"), channel("tip_deflection"),
                               channel("friction_force"), channel("energy_contact"), channel("loss_friction")}});
    Run run(p, {}, {.end = std::ranges::max(times)});
    run.add(changes);
    run.integrate();
    return {simulate(p, request), changes.all};
}

struct Case {
    const char* name;
    StickSlipFriction friction;
    double offset = 0.0184;
    int steps = 1500;
    void (*change)(Problem&) = [](Problem&) {};
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class StickSlipMotion : public ::testing::TestWithParam<Case> {};

// A collision with a fixed cam: the contact sticks, slips and is dragged back.
TEST_P(StickSlipMotion, IsThatOfTheRungeKuttaMethod) {
    const Case& c = GetParam();
    Problem p;
    p.beam.modes = 4;
    p.cam->speed = 0;
    p.contact.offset = c.offset;
    p.contact.friction = c.friction;
    c.change(p);
    ASSERT_TRUE(is_plain(p));
    const double end = 0.45;
    std::vector<double> times;
    for (double t = 0.25; t < end; t += 1.37e-4) times.push_back(t);
    set_tolerance(p, 1e-8);
    const Motion fast = motion(p, times);
    p.solver.method = Method::rk8;
    set_tolerance(p, 1e-12);
    const Motion slow = motion(p, times);

    ASSERT_EQ(fast.result.steps_by_method.size(), 1u) << "not all steps are of the collocation";
    EXPECT_LT(fast.result.counters.steps, c.steps);
    ASSERT_EQ(fast.result.impacts.size(), slow.result.impacts.size());
    EXPECT_GE(slow.result.impacts.size(), 1u);
    EXPECT_GE(slow.changes.size(), 4u);
    ASSERT_EQ(fast.changes.size(), slow.changes.size());
    for (std::size_t k = 0; k < slow.changes.size(); ++k) {
        EXPECT_EQ(fast.changes[k].state, slow.changes[k].state) << k;
        EXPECT_NEAR(fast.changes[k].t, slow.changes[k].t, 1e-8) << k;
    }
    for (std::size_t i = 0; i < fast.result.tables[0].values.size(); ++i) {
        const std::vector<double>&a = fast.result.tables[0].values[i], &b = slow.result.tables[0].values[i];
        double size = 0;
        for (const double value : b) size = std::max(size, std::fabs(value));
        for (std::size_t row = 0; row < times.size(); ++row)
            ASSERT_NEAR(a[row], b[row], 1e-6 * size) << i << " at " << times[row];
    }
    EXPECT_LT(fast.result.energy_residual_max, 1e-8 * fast.result.energy_scale);
}

void exact(Problem& p) { p.beam.model = ModelKind::exact; }
void hub(Problem& p) { p.hub = {0.1, 0.02, HarmonicTorque{0.2, 3, 0}}; }

INSTANTIATE_TEST_SUITE_P(All, StickSlipMotion,
                         ::testing::Values(Case{"Plain", {0.3, {}, {}}}, Case{"NoOffset", {0.3, {}, {}}, 0},
                                           Case{"StaticLarger", {0.2, 0.3, {}}}, Case{"Soft", {0.3, {}, 1e4}},
                                           Case{"Stiff", {0.3, {}, 1e8}}, Case{"StiffStaticLarger", {0.3, 0.4, 1e5}},
                                           Case{"Exact", {0.3, {}, {}}, 0.0184, 1500, exact},
                                           Case{"OnAHub", {0.3, 0.4, {}}, 0.0184, 1500, hub}),
                         [](const auto& given) { return given.param.name; });

TEST(FrictionStep, TakesStepsThatDoNotFollowTheHighestMode) {
    const auto steps = [](int modes, const Friction& friction) {
        Problem p;
        p.beam.modes = modes;
        p.contact.offset.reset();
        p.contact.friction = friction;
        return static_cast<double>(run(p, 0.5).counters.steps);
    };
    const StickSlipFriction bristle{0.2, {}, {}};
    EXPECT_LT(steps(30, bristle), 5 * steps(4, bristle));  // whose highest frequency is a sixtieth
    EXPECT_LT(steps(30, bristle), 1.5 * steps(30, CoulombFriction{}));
}

// Regularized friction holds a beam that a torque presses on a turning cam, and lets it slide.
Problem pressed(double slip_speed, ContactModel model) {
    Problem p;
    p.beam.modes = 3;
    p.hub.drive = ConstantTorque{-20};
    p.cam->speed = 0;
    p.contact.model = model;
    p.contact.offset.reset();
    p.contact.friction = CoulombFriction{0.4, slip_speed};
    return p;
}

TEST(FrictionStep, CreepsInStepsThatDoNotFallWithTheSlipSpeed) {
    for (const ContactModel model : {ContactModel::compliant, ContactModel::restitution}) {
        Problem p = pressed(1e-3, model);
        p.initial.shape = InitialShape::resting;
        const long steps = run(p, 1).counters.steps;
        p.contact.friction = CoulombFriction{0.4, 1e-5};
        EXPECT_LT(run(p, 1).counters.steps, 30 * steps);
    }
}

TEST(FrictionStep, CreepsInFewStepsAtRestOnAThickBeam) {
    for (const double slip_speed : {1e-6, 1e-7, 1e-8}) {
        Problem p = pressed(slip_speed, ContactModel::compliant);
        p.initial.shape = InitialShape::resting;
        EXPECT_LT(run(p, 0.3).counters.steps, 2000) << slip_speed;
    }
}

TEST(FrictionStep, SlidesAndCreepsAsByTheRungeKuttaMethod) {
    Problem p = pressed(1e-5, ContactModel::compliant);
    p.cam->speed = 3;
    Request request;
    request.tables.push_back(
        {{0.1, 0.2, 0.3}, {channel("theta"), channel("tip_deflection"), channel("loss_friction")}});
    Problem slow = p;
    slow.solver.method = Method::rk8;
    set_tolerance(slow, 1e-12);
    const Table truth = simulate(slow, request).tables[0];
    // In some of these runs the slip changes its sign between the last node of a step and its end.
    for (const double rtol : {1e-7, 1e-8, 1e-9, 1e-10, 3e-11}) {
        set_tolerance(p, rtol);
        const Result fast = simulate(p, request);
        EXPECT_EQ(fast.steps_by_method.size(), 1u) << "not all steps are of the collocation";
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t row = 0; row < 3; ++row)
                EXPECT_NEAR(fast.tables[0].values[i][row], truth.values[i][row], 30 * rtol) << i << " " << row;
    }
}

}  // namespace
}  // namespace beamcam::sim::testing
