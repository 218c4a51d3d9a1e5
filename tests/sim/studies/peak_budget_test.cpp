// The budget of a peak against the peaks of its variants.
#include "sim/studies/peak_budget.hpp"

#include <numbers>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

constexpr double kBudgetEnd = 0.42, kLongest = 60;

const PeakRow& row(const PeakBudget& budget, const std::string& change) {
    for (const PeakRow& each : budget.rows)
        if (each.change == change) return each;
    throw std::invalid_argument(change);
}

TEST(PeakBudget, RowsAreThePeaksOfTheVariants) {
    Problem p = fixed_cam(ModelKind::first_order, 4);
    const PeakBudget budget = peak_budget(p, channel("contact_force"), kBudgetEnd, kLongest);
    EXPECT_EQ(budget.peak, extremum(p, "contact_force", kBudgetEnd).max);
    p.beam.modes = 8;
    EXPECT_EQ(row(budget, "8 modes").peak, extremum(p, "contact_force", kBudgetEnd).max);
    p.beam.modes = 4;
    p.contact.stiffness = 2e8;
    EXPECT_EQ(row(budget, "stiffness × 2").peak, extremum(p, "contact_force", kBudgetEnd).max);
    EXPECT_NEAR(relative_change(budget, row(budget, "tolerance / 100")), 0, 1e-5);
}

// A rigid beam on a linear spring without loss: the force is v √(K m) of the effective mass, so it grows like √2.
TEST(PeakBudget, OfARigidBeamGrowsWithTheRootOfTheStiffness) {
    Problem p = fixed_cam(ModelKind::rigid);
    p.contact.exponent = 1;
    p.contact.stiffness = 1e9;
    p.contact.damping = DampingLaw::none;
    const PeakBudget budget = peak_budget(p, channel("contact_force"), kBudgetEnd, kLongest);
    EXPECT_NEAR(relative_change(budget, row(budget, "stiffness × 2")), std::sqrt(2.0) - 1, 1e-3);
    EXPECT_NE(budget.recommendation.find("stiffness"), std::string::npos);
}

TEST(PeakBudget, WarnsOfAForceThatHasNotConverged) {
    Problem p = fixed_cam(ModelKind::first_order, 2);
    p.contact.stiffness = 1e10;
    const PeakBudget budget = peak_budget(p, channel("contact_force"), kBudgetEnd, kLongest);
    EXPECT_NE(budget.recommendation.find("not converged"), std::string::npos) << budget.recommendation;
}

// The first touch of a beam that starts just above a hard cam.
TEST(PeakBudget, RecommendsNoMoreModesThanThereAre) {
    constexpr double kAfterTheTouch = 1e-3;
    const auto budget_of = [&](int modes) {
        Problem p = fixed_cam(ModelKind::first_order, modes);
        p.contact.stiffness = 1e12;
        p.initial.angle = 22 * std::numbers::pi / 180;
        p.initial.angular_velocity = -6;
        return peak_budget(p, channel("contact_force"), kAfterTheTouch, kLongest);
    };
    const PeakBudget most = budget_of(kMaxModes);
    EXPECT_NE(most.recommendation.find("does not converge with 40 modes"), std::string::npos) << most.recommendation;
    EXPECT_TRUE(row(budget_of(kMaxModes - 10), "40 modes").peak);
}

TEST(PeakBudget, HasTheSignOfTheLargestMagnitude) {
    Problem p = falling_beam(ModelKind::first_order);
    p.hub.drive = ConstantSpeed{0};
    p.initial.angle = 0;
    p.initial.shape = InitialShape::static_equilibrium;
    const PeakBudget budget = peak_budget(p, channel("root_moment"), 0.1, kLongest);
    EXPECT_NEAR(budget.peak, -0.5 * p.beam.line_density() * p.gravity, 1e-6);
    EXPECT_LT(std::fabs(relative_change(budget, row(budget, "1 mode"))), 1e-5);
}

TEST(PeakBudget, IsRejectedForAChannelWithoutValues) {
    EXPECT_THROW(peak_budget(falling_beam(ModelKind::rigid), channel("contact_force"), 0.1, kLongest),
                 std::invalid_argument);
}

}  // namespace
}  // namespace beamcam::sim::testing
