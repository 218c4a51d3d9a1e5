#include "sim/beam/table_smoothing.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "sim/beam/drive.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

constexpr double kEncoderStep = 2 * std::numbers::pi / 4096;  // of an encoder with 12 bits

double swing(double t) { return 0.5 * std::sin(2 * std::numbers::pi * t) + 0.1 * t; }
double swing_acceleration(double t) {
    return -2 * std::numbers::pi * std::numbers::pi * std::sin(2 * std::numbers::pi * t);
}

AngleTable encoded(double rate, double end) {
    AngleTable table;
    for (int k = 0; k <= rate * end; ++k) {
        table.t.push_back(k / rate);
        table.theta.push_back(kEncoderStep * std::round(swing(k / rate) / kEncoderStep));
    }
    return table;
}

double rms(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(a[i] - b[i], 2);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(TableSmoothing, FindsTheStepOfAnEncoder) {
    EXPECT_NEAR(*table_step(encoded(1000, 2).theta), kEncoderStep, 1e-12);
    std::vector<double> rounded = encoded(1000, 2).theta;
    for (double& each : rounded) each = std::round(each * 1e5) / 1e5;  // as text with five digits
    EXPECT_NEAR(*table_step(rounded), kEncoderStep, 1e-6);
}

TEST(TableSmoothing, FindsNoStepInAMotionOrInFewPoints) {
    std::vector<double> values;
    for (int k = 0; k < 200; ++k) values.push_back(swing(0.01 * k));
    EXPECT_FALSE(table_step(values));
    EXPECT_FALSE(table_step({0, 0.5, 0}));
    EXPECT_FALSE(table_step(std::vector<double>(50, 0.3)));
}

// Independent errors: the second difference of numbers rounded to a step has the variance step²/2.
TEST(TableSmoothing, StepsExplainTheRoughnessOfTheirErrors) {
    std::vector<double> t, errors;
    for (int k = 0; k < 20000; ++k) {
        const double x = 37.123 * k + std::sqrt(2.0) * k * k;
        t.push_back(0.01 * k);
        errors.push_back(std::round(x) - x);
    }
    const Roughness rough = roughness(t, errors, 1);
    EXPECT_NEAR(rough.found, rough.by_steps, 0.03 * rough.by_steps);
}

TEST(TableSmoothing, MinimizesTheCurvatureWithinTheDeviation) {
    // The residuals satisfy the normal equations (S93), here with dense matrices.
    const std::vector<double> t{0, 0.3, 0.5, 1.1, 1.2, 1.9, 2.4}, y{0, 0.4, 0.1, 0.8, 0.6, 0.2, 0.5};
    const double deviation = 0.05;
    const std::vector<double> found = smoothed(t, y, deviation);
    EXPECT_NEAR(rms(found, y), deviation, 1e-12);
    const Eigen::Index n = 7, m = 5;
    Matrix Q = Matrix::Zero(n, m), R = Matrix::Zero(m, m);
    for (Eigen::Index i = 0; i < m; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double h = t[k + 1] - t[k], next = t[k + 2] - t[k + 1];
        Q(i, i) = 1 / h, Q(i + 1, i) = -1 / h - 1 / next, Q(i + 2, i) = 1 / next;
        R(i, i) = (h + next) / 3;
        if (i + 1 < m) R(i, i + 1) = R(i + 1, i) = next / 6;
    }
    // y − s = λQc with Rc = Qᵀs: one λ explains all residuals.
    const Vector s = Eigen::Map<const Vector>(found.data(), n), given = Eigen::Map<const Vector>(y.data(), n);
    const Vector c = R.lu().solve(Q.transpose() * s), residual = given - s, direction = Q * c;
    const double lambda = residual.dot(direction) / direction.dot(direction);
    EXPECT_GT(lambda, 0);
    EXPECT_LT((residual - lambda * direction).norm(), 1e-10);
}

TEST(TableSmoothing, ALargeDeviationGivesTheRegressionLine) {
    std::vector<double> t, y;
    for (int k = 0; k < 30; ++k) t.push_back(0.1 * k), y.push_back(1 + 0.2 * k + 0.05 * (k % 3 - 1));
    const std::vector<double> line = smoothed(t, y, 10);
    for (std::size_t i = 1; i + 1 < t.size(); ++i) EXPECT_NEAR(line[i + 1] - 2 * line[i] + line[i - 1], 0, 1e-6);
    EXPECT_EQ(smoothed(t, y, 0), y);
}

TEST(TableSmoothing, ADriveByAnEncoderHasTheAccelerationOfTheMotion) {
    AngleTable table = encoded(1000, 2);
    const DriveLaw raw(table, 0);
    table.smooth.reset();
    const DriveLaw smooth(table, 0);
    double worst = 0, worst_raw = 0, off = 0;
    for (double t = 0.2; t < 1.8; t += 0.00037) {
        worst = std::max(worst, std::fabs(smooth.motion(t).acceleration - swing_acceleration(t)));
        worst_raw = std::max(worst_raw, std::fabs(raw.motion(t).acceleration - swing_acceleration(t)));
        off = std::max(off, std::fabs(smooth.motion(t).angle - swing(t)));
    }
    EXPECT_LT(worst, 0.15 * 2 * std::numbers::pi * std::numbers::pi);
    EXPECT_GT(worst_raw, 1000);
    EXPECT_LT(off, kEncoderStep);
}

bool warns(const Problem& p, const char* path) {
    return std::ranges::any_of(validate(p), [&](const Issue& i) { return !i.fatal && i.path == path; });
}

TEST(TableSmoothing, ValidationWarnsOfATableThatIsItsSteps) {
    Problem p;
    p.cam.reset();
    p.hub.drive = encoded(1000, 1);
    EXPECT_TRUE(warns(p, "hub.drive.theta"));
    std::get<AngleTable>(p.hub.drive).smooth.reset();
    EXPECT_TRUE(validate(p).empty());
    // Slow enough that the motion between two values is many steps: the curvature is the motion's.
    p.hub.drive = encoded(20, 4);
    EXPECT_TRUE(validate(p).empty());
    AngleTable ramp;
    for (int k = 0; k < 50; ++k) ramp.t.push_back(k), ramp.theta.push_back(0.1 * k);
    p.hub.drive = ramp;
    EXPECT_TRUE(validate(p).empty());
    AngleTable motion;
    for (int k = 0; k < 50; ++k) motion.t.push_back(0.1 * k), motion.theta.push_back(swing(0.1 * k));
    motion.smooth.reset();
    p.hub.drive = motion;
    ASSERT_EQ(validate(p).size(), 1u);
    EXPECT_EQ(validate(p)[0].path, "hub.drive.smooth");
}

}  // namespace
}  // namespace beamcam::sim::testing
