#include "sim/contact/contact_law.hpp"

#include <cmath>
#include <map>
#include <numbers>

#include "sim/base/numerics.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

const NormalLaw kHertz{1e8, 1.5, 0};

TEST(NormalLaw, IsZeroWithoutPenetration) {
    const NormalLaw law{1e8, 1.5, 0.4};
    EXPECT_EQ(law.force(0, 1, 1), 0);
    EXPECT_EQ(law.force(-1e-3, 1, 1), 0);
    EXPECT_EQ(law.stored_energy(-1e-3), 0);
}

TEST(NormalLaw, IsThePowerLawAtRestAndGrowsOnApproach) {
    for (double n : {1.0, 1.2, 1.5, 2.0}) {
        const NormalLaw law{3e6, n, 0.8};
        EXPECT_NEAR(law.force(2e-3, 0, 1), 3e6 * std::pow(2e-3, n), 1e-12 * law.force(2e-3, 0, 1));
        EXPECT_NEAR(law.force(2e-3, 0.5, 2), 1.2 * law.force(2e-3, 0, 2), 1e-12 * law.force(2e-3, 0, 2));
    }
}

TEST(NormalLaw, NeverPulls) {
    const NormalLaw law{1e8, 1.5, 2};
    EXPECT_GT(law.force(1e-3, -0.4, 1), 0);
    EXPECT_EQ(law.force(1e-3, -0.6, 1), 0);
}

TEST(NormalLaw, ForceIsTheDerivativeOfTheStoredEnergy) {
    for (double n : {1.0, 1.5, 2.0}) {
        const NormalLaw law{1e7, n, 0};
        const double slope = scalar_slope_at_zero([&](double e) { return law.stored_energy(1e-3 + e); }, 1e-5);
        EXPECT_NEAR(slope, law.elastic(1e-3), 1e-9 * law.elastic(1e-3));
    }
}

// ---- one-dimensional impact of a mass, by an integrator of the library --------------------------------

struct Impact1 : Ode {
    NormalLaw law;
    double mass = 1, approach = 1;
    Impact1() { size = controlled = 2; }
    void rhs(double, const double* y, double* dy) override {
        dy[0] = y[1];
        dy[1] = -law.force(y[0], y[1], approach) / mass;
    }
};

struct Rebound {
    double restitution = 0, deepest = 0, strongest = 0, duration = 0;
};

Rebound bounce(const NormalLaw& law, double mass, double speed) {
    Impact1 impact;
    impact.law = law;
    impact.mass = mass;
    impact.approach = speed;
    const auto integrator = make_rk8(impact, 1e-13, 1e-18);
    double y[2] = {0, speed};
    integrator->start(0, y);
    Rebound r;
    for (int step = 0; step < 100000; ++step) {
        const Segment& s = integrator->step();
        double end[2], z[2];
        s.value(s.t1, end);
        s.value(s.t0, z);
        if (z[1] > 0 && end[1] <= 0) {
            const double t = find_root(
                [&](double at) {
                    s.value(at, y);
                    return y[1];
                },
                s.t0, s.t1);
            s.value(t, y);
            r.deepest = y[0];
            r.strongest = law.force(y[0], 0, speed);
        }
        if (end[0] < 0 || (r.deepest > 0 && law.force(end[0], end[1], speed) == 0)) {
            // The gap is open, or the force is zero: in the first case the speed at zero gap is the final one.
            if (end[0] < 0) {
                r.duration = find_root(
                    [&](double at) {
                        s.value(at, y);
                        return y[0];
                    },
                    s.t0, s.t1);
                s.value(r.duration, y);
                r.restitution = -y[1] / speed;
                return r;
            }
        }
    }
    ADD_FAILURE() << "no rebound";
    return r;
}

TEST(HertzImpact, HasThePublishedDepthForceAndDuration) {
    const Rebound r = bounce(kHertz, 1, 1);
    EXPECT_NEAR(r.deepest, 0.0006898648307306075, 1e-12 * 6.9e-4);
    EXPECT_NEAR(r.strongest, 1811.949159194239, 1e-11 * 1812);
    EXPECT_NEAR(r.duration, 0.00203046203682776,
                1e-9 * 2e-3);  // the gap opens with a finite speed: steps end there at 1e-9 of it
    EXPECT_NEAR(r.restitution, 1, 1e-10);
    EXPECT_NEAR(r.duration / r.deepest, 2.9432751843247047, 1e-8);
}

TEST(LinearImpact, LastsHalfAPeriod) {
    const Rebound r = bounce({1e6, 1, 0}, 2, 0.3);
    EXPECT_NEAR(r.duration * 0.3 / r.deepest, std::numbers::pi, 1e-9);
    EXPECT_NEAR(r.duration, std::numbers::pi * std::sqrt(2 / 1e6), 1e-11);
}

// ---- dissipation -------------------------------------------------------------------------------

TEST(DampingLaws, ZhangSharfReturnsItsPreset) {
    for (double c = 0.01; c < 1; c += 0.01)
        EXPECT_NEAR(effective_restitution(damping_factor(DampingLaw::zhang_sharf, c)), c, 1e-11) << c;
    EXPECT_NEAR(effective_restitution(damping_factor(DampingLaw::zhang_sharf, 0.999999)), 0.999999, 1e-10);
    EXPECT_EQ(damping_factor(DampingLaw::zhang_sharf, 1), 0);
}

TEST(DampingLaws, SimulatedImpactsReturnTheEffectiveRestitution) {
    // While 1 + Dδ̇/δ̇₋ stays positive (D e < 1) it is exact, whatever mass, stiffness, exponent and speed.
    for (const auto& law : names(DampingLaw{}))
        for (double n : {1.0, 1.5, 2.0}) {
            const double d = damping_factor(law.value, 0.7);
            EXPECT_NEAR(bounce({1e7, n, d}, 0.3, 0.8).restitution, effective_restitution(d), 1e-8)
                << law.name << " " << n;
        }
}

TEST(DampingLaws, VanishAtFullRestitution) {
    for (const auto& law : names(DampingLaw{})) EXPECT_EQ(damping_factor(law.value, 1), 0) << law.name;
    EXPECT_EQ(effective_restitution(0), 1);
}

TEST(DampingLaws, MoreDampingGivesLessRebound) {
    double before = 1;
    for (double d : {1e-9, 1e-4, 0.01, 0.0199, 0.0201, 0.3, 1.0, 3.0, 50.0, 1e4}) {
        const double e = effective_restitution(d);
        EXPECT_LT(e, before) << d;
        EXPECT_GT(e, 0) << d;
        before = e;
    }
    EXPECT_NEAR(effective_restitution(1e-9), 1 - 2e-9 / 3, 1e-15);  // e ≈ 1 − 2D/3
}

TEST(Stiffness, OfHertzIsThatOfBothMaterials) {
    Problem p;
    p.contact.stiffness.reset();
    // Equal materials: E* = E/2/(1 − ν²).
    const double e = p.beam.youngs_modulus, reduced = e / (2 * (1 - 0.09));
    EXPECT_NEAR(contact_stiffness(p), 4.0 / 3 * reduced * std::sqrt(0.1), 1e-3);
    EXPECT_NEAR(contact_stiffness(p), 1.6e10, 0.05e10);
    p.cam->youngs_modulus = 1e30;  // rigid cam
    EXPECT_NEAR(contact_stiffness(p), 4.0 / 3 * 2 * reduced * std::sqrt(0.1), 1e-2);
    p.contact.stiffness = 5;
    EXPECT_EQ(contact_stiffness(p), 5);
}

TEST(Offset, IsGivenOrHalfTheDepth) {
    Problem p;
    EXPECT_EQ(contact_offset(p), 0);
    p.contact.offset.reset();
    EXPECT_EQ(contact_offset(p), 0.5 * p.beam.depth);
}

}  // namespace
}  // namespace beamcam::sim::testing
