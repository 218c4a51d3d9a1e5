#include "sim/contact/impulse.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "sim/run/simulate.hpp"

namespace beamcam::sim {
namespace {

constexpr ImpactLaw kLaws[] = {ImpactLaw::newton, ImpactLaw::poisson, ImpactLaw::stronge};

TEST(Impact, FrictionObeysItsConeAndStrongeNeverGainsEnergy) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 2000; ++i) {
        const double nn = 0.1 + unit(random), tt = 0.1 + unit(random),
                     nt = (2 * unit(random) - 1) * 0.99 * std::sqrt(nn * tt);
        const double v_n = -unit(random) - 1e-3, v_t = 4 * unit(random) - 2, mu = 2 * unit(random), e = unit(random);
        for (const ImpactLaw law : kLaws) {
            const ImpactResult r = resolve_impact(Compliance{nn, nt, tt}, v_n, v_t, mu, e, law);
            EXPECT_GT(r.impulse_n, 0);
            EXPECT_LE(std::fabs(r.impulse_t), mu * r.impulse_n * (1 + 1e-12));
            EXPECT_GE(r.v_n, -1e-12);
            const double gained = 0.5 * (r.impulse_n * (v_n + r.v_n) + r.impulse_t * (v_t + r.v_t));
            if (law == ImpactLaw::stronge) {
                EXPECT_LE(gained, 1e-12);
            }
            if (law == ImpactLaw::newton) {
                EXPECT_NEAR(r.v_n, -e * v_n, 1e-12);
            }
        }
    }
}

// A rigid rod under a constant torque on a tiny disc is a ball under constant gravity: the gap is linear in θ to θ²/6.
TEST(Impact, ABouncingBallEndsInSustainedContact) {
    Problem problem;
    problem.gravity = 0;
    problem.beam.model = ModelKind::rigid;
    const double lever = 0.5, radius = 1e-6, height = 1e-5, pull = 2;  // of the gap: D [m], R [m], h [m], g_eff [m/s²]
    problem.cam->centre = {lever, 0};
    problem.cam->radius = radius;
    problem.cam->eccentricity = problem.cam->speed = 0;
    problem.contact.model = ContactModel::restitution;
    problem.contact.restitution = 0.8;
    problem.hub.drive = ConstantTorque{-pull / lever * problem.beam.line_density() / 3};
    problem.initial.angle = std::asin((radius + height) / lever);
    problem.solver.rtol = 1e-12;
    problem.solver.atol = 1e-18;
    const double scale = std::sqrt(height / pull * 9.81);  // of times, to those for h = 1 m, g = 9.81 m/s²
    // The end of the Zeno sequence, 4.0637 for e = 0.8: then rest without further touches.
    Request longer;
    longer.end_time = 5 * scale;
    const Result rest = simulate(problem, longer);
    EXPECT_FALSE(rest.impacts.back().t_end.has_value());
    // A pure impulse has no finite force; sustained contact has: the weight that the disc carries.
    EXPECT_FALSE(rest.impacts.front().force_peak.has_value());
    const double borne = pull * problem.beam.line_density() / 3 / (lever * lever);
    EXPECT_NEAR(rest.impacts.back().force_peak.value(), borne, 1e-6 * borne);
    EXPECT_NEAR(rest.impacts.back().t_start / scale, 4.063712768871579, 3e-3);
}

// Chatter of a vibrating beam: the brief last bounces are summed up, so that their number and the instant of rest do
// not depend on the method.
TEST(Impact, ChatterOfAFlexibleBeamEndsAlikeWithEveryMethod) {
    Problem problem;
    problem.contact.model = ContactModel::restitution;
    problem.contact.friction = CoulombFriction{0.2, 1e-3};
    Request request;
    request.end_time = 0.281;
    const Result reference = simulate(problem, request);
    ASSERT_GT(reference.impacts.size(), 20u);
    const Impact& rest = reference.impacts.back();
    const Impact& last = reference.impacts[reference.impacts.size() - 2];
    EXPECT_EQ(rest.v_n_before, 0);
    EXPECT_GT(rest.duration.value_or(1), 0);
    EXPECT_LT(last.v_n_after.value(), 1e-4);
    EXPECT_NEAR(last.restitution.value(), problem.contact.restitution, 1e-9);
    EXPECT_LT(reference.energy_residual_max, 10 * problem.solver.rtol * reference.energy_scale);
    problem.solver.method = Method::rk8;
    const Result other = simulate(problem, request);
    ASSERT_EQ(other.impacts.size(), reference.impacts.size());
    EXPECT_NEAR(other.impacts.back().t_start, rest.t_start, 2e-8);
}

// Rounding of the rebound does not decide whether it is chatter.
TEST(Impact, APlasticImpactThatSustainedContactFollowsIsListedOnce) {
    for (const Method method : {Method::automatic, Method::rk8, Method::cvode_adams})
        for (const ImpactLaw law : {ImpactLaw::newton, ImpactLaw::poisson, ImpactLaw::stronge})
            for (const int modes : {2, 3}) {
                Problem problem;
                problem.beam.modes = modes;
                problem.contact.model = ContactModel::restitution;
                problem.contact.law = law;
                problem.contact.restitution = 0;
                problem.contact.friction = CoulombFriction{0.3, 1e-3};
                problem.initial = {0.5, -3, InitialShape::straight};
                problem.solver.method = method;
                Request request;
                request.end_time = 0.3;
                const Result result = simulate(problem, request);
                ASSERT_FALSE(result.impacts.empty());
                for (const Impact& impact : result.impacts)
                    EXPECT_LT(impact.v_n_before, 0) << name(method) << " " << name(law) << " " << modes;
            }
}

// With a constant acceleration the sum is exact: chatter that is integrated down to a thousandth of the speed agrees.
TEST(Impact, SummedUpChatterEqualsTheIntegratedBounces) {
    Problem problem;
    problem.contact.model = ContactModel::restitution;
    Request request;
    request.end_time = 0.29;
    request.tables.push_back({{0.285, 0.29}, {{ChannelKind::theta, 0}, {ChannelKind::theta_dot, 0}}});
    const Result early = simulate(problem, request);
    problem.contact.approach_floor.value = 1e-5;  // the sum begins at 1e-6 m/s
    const Result late = simulate(problem, request);
    EXPECT_GT(late.impacts.size(), early.impacts.size() + 5);
    for (std::size_t row = 0; row < 2; ++row) {
        EXPECT_NEAR(early.tables[0].values[0][row], late.tables[0].values[0][row], 1e-9);
        EXPECT_NEAR(early.tables[0].values[1][row], late.tables[0].values[1][row], 1e-7);
    }
}

}  // namespace
}  // namespace beamcam::sim
