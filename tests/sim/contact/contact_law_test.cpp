#include "sim/contact/contact_law.hpp"

#include <cmath>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

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

// ---- dissipation -------------------------------------------------------------------------------

// The law's own balance of energy, D(1 + e) = ln((1 + D)/(1 − eD)).
TEST(DampingLaws, ZhangSharfReturnsItsPreset) {
    for (double e = 0.01; e < 1; e += 0.01) {
        const double d = damping_factor(DampingLaw::zhang_sharf, e);
        const double slope = e * d * d / (1 - e * d);  // of the balance, over e
        EXPECT_NEAR(std::log1p(d) - std::log1p(-e * d) - d * (1 + e), 0, 1e-11 * slope + 1e-15) << e;
    }
    EXPECT_NEAR(damping_factor(DampingLaw::zhang_sharf, 0.999999), 1.5e-6, 1e-11);  // e ≈ 1 − 2D/3
    EXPECT_EQ(damping_factor(DampingLaw::zhang_sharf, 1), 0);
}

TEST(DampingLaws, VanishAtFullRestitution) {
    for (const auto& law : names(DampingLaw{})) EXPECT_EQ(damping_factor(law.value, 1), 0) << law.name;
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
    EXPECT_EQ(contact_offset(p), 0.5 * beam_depth(p.beam));
}

}  // namespace
}  // namespace beamcam::sim::testing
