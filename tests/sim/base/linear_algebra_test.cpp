#include "sim/base/linear_algebra.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace beamcam::sim {
namespace {

// A chain of n equal masses and springs between walls: ω_k = 2 sin(kπ/2(n + 1)).
TEST(LinearAlgebra, NaturalModesOfAChain) {
    const int n = 12;
    Eigen::MatrixXd stiffness = 2 * Eigen::MatrixXd::Identity(n, n);
    for (int i = 1; i < n; ++i) stiffness(i, i - 1) = stiffness(i - 1, i) = -1;
    const Eigen::MatrixXd mass = 4 * Eigen::MatrixXd::Identity(n, n);
    const Eigenmodes modes = eigenmodes(stiffness, mass);
    for (int k = 1; k <= n; ++k)
        EXPECT_NEAR(modes.omega_squared[k - 1], std::pow(std::sin(k * std::numbers::pi / (2 * (n + 1))), 2), 1e-14);
    const Eigen::MatrixXd product = modes.shapes.transpose() * mass * modes.shapes;
    EXPECT_LT((product - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_THROW(eigenmodes(stiffness, -mass), std::domain_error);
}

// The companion matrix of (λ² + 1)(λ − 2)(λ + 3).
TEST(LinearAlgebra, EigenvaluesOfACompanionMatrix) {
    Eigen::MatrixXd companion(4, 4);
    companion << -1, 5, -1, 6, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0;
    const Eigen::VectorXcd values = eigenvalues(companion);
    for (const std::complex<double> expected : {std::complex<double>{0, 1}, {0, -1}, {2, 0}, {-3, 0}})
        EXPECT_LT((values.array() - expected).abs().minCoeff(), 1e-14) << expected;
    const Eigen::VectorXcd v = eigenvector_nearest(companion, -2.5);
    EXPECT_LT((companion * v + 3.0 * v).norm(), 1e-14);
    EXPECT_NEAR(v.norm(), 1, 1e-15);
}

// What is no number has no eigenvalues, and says so.
TEST(LinearAlgebra, EigenvaluesOfNoNumbersAreNone) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(3, 3);
    matrix(1, 2) = std::nan("");
    const Eigen::VectorXcd values = eigenvalues(matrix);
    ASSERT_EQ(values.size(), 3);
    EXPECT_TRUE(std::all_of(values.begin(), values.end(), [](const auto& v) { return std::isnan(std::abs(v)); }));
}

TEST(LinearAlgebra, SolvesWhatNeedsPivots) {
    Eigen::MatrixXd a(3, 3);
    a << 0, 2, 1, 1e-20, 1, 0, 3, 0, 0;
    const Eigen::VectorXd x = Eigen::Vector3d(7, -1, 4);
    EXPECT_LT((solve(a, a * x) - x).norm(), 1e-14);
}

}  // namespace
}  // namespace beamcam::sim
