#include "sim/studies/paper.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "sim/beam/modes.hpp"

namespace beamcam::sim {
namespace {

constexpr double kPi = std::numbers::pi;

// Torque doubled or inertia halved: only their ratio counts.
TEST(Paper, AFactorTwoGivesThePapersTime) {
    EXPECT_NEAR(rod_fall_time(1, 9.81, kPi / 4, 1), 0.369998497559697, 1e-14);
    EXPECT_NEAR(rod_fall_time(1, 9.81, kPi / 4, 2), 0.261628446653, 1e-12);
    EXPECT_NEAR(rod_fall_time(1, 9.81, kPi / 4, 2) * std::sqrt(2.0), rod_fall_time(1, 9.81, kPi / 4, 1), 1e-14);
}

TEST(Paper, DeflectionAsPrintedJumpsInSlopeAndTheCorrectedOneDoesNot) {
    const Problem problem;
    for (const double support : {0.2, 0.23, 0.4, 0.6}) {
        const double angle = 0.3;
        const auto at = [&](Printing printing, double x, bool overhang) {
            return supported_beam(problem, angle, support, x, printing, overhang);
        };
        const StaticDeflection left = at(Printing::corrected, support, false),
                               right = at(Printing::corrected, support, true);
        EXPECT_NEAR(left.v, 0, 1e-18);
        EXPECT_NEAR(right.v, 0, 1e-18);
        EXPECT_NEAR(left.slope, right.slope, 1e-15);
        const double jump = at(Printing::printed, support, false).slope - at(Printing::printed, support, true).slope;
        const double q = problem.beam.line_density() * problem.gravity, c = std::cos(angle);
        EXPECT_NEAR(jump, q * std::pow(support, 3) / (24 * c) / problem.beam.bending_stiffness(), 1e-15);
        EXPECT_EQ(at(Printing::corrected, 0, false).v, 0);  // hinged at O
    }
}

// At the paper's contact nearly all of the error of its eq. (5) is the missing factor 1/cos²θ.
TEST(Paper, MissingTermsOfTheDeflectionAreSmall) {
    const Problem problem;
    const double angle = std::asin(problem.cam->radius / norm(problem.cam->centre));
    const double support = tangent_distance(*problem.cam, 0, Printing::printed);
    const auto at = [&](double x, Printing printing, bool overhang) {
        return supported_beam(problem, angle, support, x, printing, overhang);
    };
    const double end = problem.beam.length * std::cos(angle);
    const auto tip = [&](Printing printing) { return at(end, printing, true).v; };
    EXPECT_NEAR(tip(Printing::completed) / tip(Printing::printed) - 1, -0.009, 0.001);
    EXPECT_NEAR(tip(Printing::corrected) / tip(Printing::completed), 1 / std::pow(std::cos(angle), 2), 1e-12);
    EXPECT_NEAR(at(support, Printing::completed, false).slope, at(support, Printing::completed, true).slope, 1e-15);
}

TEST(Paper, WithoutEccentricityThePrintedTangentIsRight) {
    Problem problem;
    problem.cam->eccentricity = 0;
    EXPECT_NEAR(tangent_distance(*problem.cam, 0, Printing::printed), std::sqrt(0.25 * 0.25 - 0.01), 1e-15);
    EXPECT_NEAR(tangent_distance(*problem.cam, 0, Printing::corrected), std::sqrt(0.25 * 0.25 - 0.01), 1e-15);
}

// Twice the centrifugal term, as the paper prints its variation of T, would give 7.1.
TEST(Modes, StiffeningOfTheTurningBeamHasTheFactorOne) {
    Problem problem;
    problem.beam.basis = Basis::cantilever;
    problem.beam.modes = 12;
    const double unit = std::sqrt(problem.beam.bending_stiffness() / problem.beam.line_density()), turning = 4;
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order}) {
        problem.beam.model = kind;
        const double omega = natural_modes(problem, turning * unit).at(0).omega / unit;
        EXPECT_NEAR(std::sqrt(omega * omega + turning * turning), 5.585001421, 1e-4) << name(kind);
    }
}

// φᵢ(L) of a uniform beam that is clamped or hinged at its root is ±2/√m for every i.
TEST(Modes, TipIsPositive) {
    for (const Basis basis : {Basis::hub_beam, Basis::cantilever}) {
        Problem problem;
        problem.beam.basis = basis;
        problem.beam.modes = 6;
        const double tip = 2 / std::sqrt(problem.beam.line_density() * problem.beam.length);
        const bool clamped = basis == Basis::cantilever;
        for (const Mode& mode : natural_modes(problem, clamped ? std::optional(0.0) : std::nullopt))
            EXPECT_NEAR(mode.shape.back().y, tip, 1e-9 * tip) << name(basis) << " " << mode.omega;
    }
}

}  // namespace
}  // namespace beamcam::sim
