#include "sim/base/numerics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace beamcam::sim {
namespace {

TEST(GaussLegendre, IsExactUpToItsDegree) {
    const double length = 1.3;
    for (int n : {1, 2, 3, 5, 12, 40}) {
        const Quadrature rule = gauss_legendre(n, length);
        for (int degree = 0; degree <= 2 * n - 1; ++degree) {
            double sum = 0;
            for (Eigen::Index k = 0; k < n; ++k) sum += rule.w[k] * std::pow(rule.x[k] / length, degree);
            EXPECT_NEAR(sum, length / (degree + 1), 4e-15 * n) << n << " nodes, degree " << degree;
        }
    }
}

TEST(GaussLegendre, IsNotExactBeyondItsDegree) {
    const Quadrature rule = gauss_legendre(2, 1);
    EXPECT_GT(std::fabs(rule.w.dot(rule.x.array().pow(4).matrix()) - 0.2), 1e-3);
}

TEST(GaussLegendre, NodesAscendInsideAndAreSymmetric) {
    for (int n : {1, 7, 64, 144}) {
        const Quadrature rule = gauss_legendre(n, 2);
        for (Eigen::Index k = 0; k < n; ++k) {
            EXPECT_GT(rule.x[k], k ? rule.x[k - 1] : 0.0);
            EXPECT_LT(rule.x[k], 2);
            EXPECT_NEAR(rule.x[k] + rule.x[n - 1 - k], 2, 1e-15 * 8);
            EXPECT_GT(rule.w[k], 0);
        }
    }
}

TEST(SpectralIntegral, IntegratesPolynomialsFromZeroToAnywhere) {
    const double length = 0.7;
    const Quadrature rule = gauss_legendre(12, length);
    const SpectralIntegral integral(rule, length);
    Eigen::VectorXd weights(12);
    for (int degree = 0; degree <= 11; ++degree)
        for (double x : {0.0, 0.05, 0.31, 0.699, 0.7}) {
            integral.weights(x, weights.data());
            const double sum = weights.dot((rule.x / length).array().pow(degree).matrix());
            EXPECT_NEAR(sum, length * std::pow(x / length, degree + 1) / (degree + 1), 1e-14) << degree << " to " << x;
        }
}

TEST(SpectralIntegral, MatrixHoldsTheWeightsOfItsNodes) {
    const Quadrature rule = gauss_legendre(9, 3);
    const SpectralIntegral integral(rule, 3);
    const Eigen::MatrixXd matrix = integral.matrix(rule);
    Eigen::VectorXd weights(9);
    for (Eigen::Index k = 0; k < 9; ++k) {
        integral.weights(rule.x[k], weights.data());
        EXPECT_LT((matrix.row(k).transpose() - weights).cwiseAbs().maxCoeff(), 1e-16);
    }
}

TEST(SpectralIntegral, ConvergesOnSmoothFunctions) {
    const Quadrature rule = gauss_legendre(24, 1);
    const SpectralIntegral integral(rule, 1);
    Eigen::VectorXd weights(24);
    integral.weights(0.6, weights.data());
    EXPECT_NEAR(weights.dot((9 * rule.x).array().cos().matrix()), std::sin(5.4) / 9, 1e-14);
}

TEST(FindRoot, ReachesTheLastBits) {
    EXPECT_NEAR(find_root([](double x) { return x * x * x - 2 * x - 5; }, 2, 3), 2.0945514815423265915, 1e-15);
    EXPECT_NEAR(find_root([](double x) { return std::cos(x) - x; }, 0, 1), 0.73908513321516064166, 2e-16);
    EXPECT_NEAR(find_root([](double x) { return std::exp(-x) - 1e-8; }, 0, 1000), 18.420680743952367, 1e-14);
    // A steep corner and a flat root: bisection must carry the day.
    EXPECT_NEAR(find_root([](double x) { return x < 0.123456 ? -1e-9 : 1e9; }, 0, 1), 0.123456, 1e-15);
    EXPECT_NEAR(find_root([](double x) { return std::pow(x - 0.5, 9); }, 0, 1.1), 0.5, 1e-12);
}

TEST(FindRoot, ReturnsAnEndThatIsARoot) {
    const auto f = [](double x) { return x * (x - 2); };
    EXPECT_EQ(find_root(f, 0, 1), 0);
    EXPECT_EQ(find_root(f, 1, 2), 2);
}

TEST(Legendre, MatchesClosedFormsAndNeedsNoPolynomials) {
    double p[5];
    legendre(0.3, 5, p);
    EXPECT_DOUBLE_EQ(p[2], 0.5 * (3 * 0.09 - 1));
    EXPECT_NEAR(p[4], (35 * std::pow(0.3, 4) - 30 * 0.09 + 3) / 8, 1e-16);
    double untouched = 7;
    legendre(0.3, 0, &untouched);
    EXPECT_EQ(untouched, 7);
}

#ifdef BEAMCAM_CHECKS
TEST(PreconditionsDeathTest, ARootMustBeBracketed) {
    EXPECT_DEATH(find_root([](double x) { return x; }, 1, 2), "precondition violated");
}
#endif

// They enclose the maximum, or the first is the highest and the parabola has its top beside it.
TEST(Climb, FindsTheMaximumBetweenThreePoints) {
    const auto f = [](double x) { return std::cos(x) + 0.1 * std::sin(3 * x); };
    double best = -2;
    for (int k = 0; k < 1'000'000; ++k) best = std::max(best, f(1e-6 * k));
    for (const double first : {-0.3, 0.0, 0.2}) {
        const auto at = [&](double x) { return Vec2{x, f(x)}; };
        const Vec2 top = climb(f, at(first), at(first + 0.4), at(first + 0.8), 0, 1e-12);
        EXPECT_NEAR(top.y, best, 1e-12) << first;
        EXPECT_EQ(f(top.x), top.y);
    }
}

TEST(Climb, EndsWhereTheParabolaDoesNotPromiseMore) {
    int evaluations = 0;
    const auto f = [&](double x) { return ++evaluations, std::cos(x); };
    EXPECT_EQ(climb(f, {-0.5, std::cos(0.5)}, {0.1, std::cos(0.1)}, {0.6, std::cos(0.6)}, 1.1, 1e-9).x, 0.1);
    EXPECT_EQ(evaluations, 0);
    EXPECT_FALSE(vertex({0, 0}, {1, 0}, {2, 0}));
    EXPECT_FALSE(vertex({0, 1}, {1, 0}, {2, 1}));
    EXPECT_FALSE(vertex({0, 0}, {1, 1}, {2, 1.9}));  // beyond the last
}

}  // namespace
}  // namespace beamcam::sim
