#include "sim/beam/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/base/numerics.hpp"

namespace beamcam::sim {
namespace {

// Inner products of shapes with the mass of beam and hub, per unit of ρAL.
Eigen::MatrixXd gram(const Shapes& shapes, double length, double inertia) {
    const int n = shapes.count();
    const Quadrature rule = gauss_legendre(4 * n + 40, length);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd y(n), y1(n);
    for (Eigen::Index k = 0; k < rule.x.size(); ++k) {
        shapes.evaluate(rule.x[k], y.data(), nullptr, nullptr);
        sum += rule.w[k] * y * y.transpose();
    }
    shapes.evaluate(0, nullptr, y1.data(), nullptr);
    sum += inertia * y1 * y1.transpose();
    return sum / length;
}

double distance_to_identity(const Eigen::MatrixXd& m) {
    return (m - Eigen::MatrixXd::Identity(m.rows(), m.cols())).cwiseAbs().maxCoeff();
}

TEST(CantileverShapes, ScaleWithTheLength) {
    const Shapes one = Shapes::cantilever(5, 1), other = Shapes::cantilever(5, 0.037);
    double y[5], z[5];
    one.evaluate(0.4, y, nullptr, nullptr);
    other.evaluate(0.4 * 0.037, z, nullptr, nullptr);
    for (int i = 0; i < 5; ++i) {
        EXPECT_NEAR(other.beta(i) * 0.037, one.beta(i), 1e-14 * one.beta(i));
        EXPECT_NEAR(z[i], y[i], 1e-13);
    }
}

TEST(CantileverShapes, FortyAreOrthonormal) {
    EXPECT_LT(distance_to_identity(gram(Shapes::cantilever(40, 1.7), 1.7, 0)), 1e-11);
}

TEST(CantileverShapes, MeetTheBoundaryConditionsAndReachTwoAtTheTip) {
    const int n = 40;
    const double length = 2.5;
    const Shapes shapes = Shapes::cantilever(n, length);
    double y[40], y1[40], y2[40];
    shapes.evaluate(0, y, y1, nullptr);
    for (int i = 0; i < n; ++i) {
        EXPECT_NEAR(y[i], 0, 1e-13) << i + 1;
        EXPECT_NEAR(y1[i] / shapes.beta(i), 0, 1e-13) << i + 1;
    }
    shapes.evaluate(length, y, nullptr, y2);
    for (int i = 0; i < n; ++i) {
        EXPECT_NEAR(y[i], i % 2 ? -2 : 2, 1e-12) << i + 1;
        EXPECT_NEAR(y2[i] / std::pow(shapes.beta(i), 2), 0, 1e-12) << i + 1;  // no moment at the tip
    }
}

// Natural boundary conditions follow from EI∫yᵢ″yⱼ″ = β⁴ m δᵢⱼ, which holds only if moment and shear
// vanish where nothing carries them.
void expect_orthogonal_curvatures(const Shapes& shapes, double length) {
    const int n = shapes.count();
    const Quadrature rule = gauss_legendre(4 * n + 40, length);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd y2(n);
    for (Eigen::Index k = 0; k < rule.x.size(); ++k) {
        shapes.evaluate(rule.x[k], nullptr, nullptr, y2.data());
        for (int i = 0; i < n; ++i) y2[i] /= std::pow(shapes.beta(i), 2);
        sum += rule.w[k] / length * y2 * y2.transpose();
    }
    EXPECT_LT(distance_to_identity(sum), 1e-10);
}

TEST(CantileverShapes, HaveOrthogonalCurvatures) { expect_orthogonal_curvatures(Shapes::cantilever(40, 0.8), 0.8); }

struct Hub {
    double radius, inertia;  // in lengths, and in cubed lengths (I_h/ρA)
};

TEST(HubBeamShapes, AreOrthonormalForAnyHub) {
    for (const Hub& hub : {Hub{0, 0}, Hub{0.1, 0}, Hub{0.1, 0.02}, Hub{2, 0}, Hub{0, 5}, Hub{-0.3, 0}, Hub{-0.5, 0.01},
                           Hub{-0.95, 0}, Hub{0.2, 1e4}})
        for (int n : {1, 2, 7, 40}) {
            const Shapes shapes = Shapes::hub_beam(n, 1, hub.radius, hub.inertia);
            EXPECT_LT(distance_to_identity(gram(shapes, 1, hub.inertia)), 1e-11)
                << n << " shapes, a = " << hub.radius << ", I_h = " << hub.inertia;
        }
}

TEST(HubBeamShapes, DoNotTurnTheMeanAxisAndSitOnTheHub) {
    for (const Hub& hub : {Hub{0, 0}, Hub{0.15, 0.03}, Hub{-0.4, 0}, Hub{-0.7, 0.2}}) {
        const int n = 40;
        const Shapes shapes = Shapes::hub_beam(n, 1, hub.radius, hub.inertia);
        const Quadrature rule = gauss_legendre(4 * n, 1);
        Eigen::VectorXd y(n), y1(n), turn = Eigen::VectorXd::Zero(n);
        for (Eigen::Index k = 0; k < rule.x.size(); ++k) {
            shapes.evaluate(rule.x[k], y.data(), nullptr, nullptr);
            turn += rule.w[k] * (hub.radius + rule.x[k]) * y;
        }
        shapes.evaluate(0, y.data(), y1.data(), nullptr);
        turn += hub.inertia * y1;
        for (int i = 0; i < n; ++i) {
            EXPECT_NEAR(turn[i], 0, 1e-12) << i + 1;
            EXPECT_NEAR(y[i] - hub.radius * y1[i], 0, 1e-12 * (1 + std::fabs(hub.radius * y1[i]))) << i + 1;
        }
    }
}

TEST(HubBeamShapes, HaveOrthogonalCurvaturesForAnyHub) {
    for (const Hub& hub : {Hub{0, 0}, Hub{0.15, 0.03}, Hub{-0.4, 0}, Hub{0.3, 100}})
        expect_orthogonal_curvatures(Shapes::hub_beam(40, 1, hub.radius, hub.inertia), 1);
}

TEST(HubBeamShapes, TendToTheClampedOnesAsTheHubGrowsHeavy) {
    const Shapes clamped = Shapes::cantilever(6, 1);
    double before = 1;
    for (double inertia : {1e2, 1e4, 1e6, 1e9}) {
        const Shapes shapes = Shapes::hub_beam(6, 1, 0.3, inertia);
        double worst = 0;
        for (int i = 0; i < 6; ++i) worst = std::max(worst, std::fabs(shapes.beta(i) / clamped.beta(i) - 1));
        EXPECT_LT(worst, 1.0 / inertia) << inertia;  // the hub gives way in proportion to 1/I_h
        EXPECT_LT(worst, before);
        before = worst;
    }
}

TEST(HubBeamShapes, AscendWithoutGaps) {
    // One eigenvalue in each interval of π, shifted by at most one: none is skipped or found twice.
    for (const Hub& hub : {Hub{0, 0}, Hub{1e-3, 1e-6}, Hub{5, 0.1}, Hub{-0.999, 0}, Hub{-0.25, 3}}) {
        const Shapes shapes = Shapes::hub_beam(40, 1, hub.radius, hub.inertia);
        for (int i = 1; i < 40; ++i) {
            const double step = shapes.beta(i) - shapes.beta(i - 1);
            EXPECT_GT(step, 0.3) << hub.radius << " " << i;
            EXPECT_LT(step, 6.3) << hub.radius << " " << i;
        }
        EXPECT_LT(shapes.beta(39), 41 * 3.14159265358979);
    }
}

TEST(Shapes, DerivativesAreDerivatives) {
    const Shapes shapes = Shapes::hub_beam(12, 1.4, 0.1, 0.01);
    const double h = 1e-4;
    double y[12], y1[12], y2[12], plus[12], minus[12], plus1[12], minus1[12];
    for (double x : {0.2, 0.7, 1.3}) {
        shapes.evaluate(x, y, y1, y2);
        shapes.evaluate(x + h, plus, plus1, nullptr);
        shapes.evaluate(x - h, minus, minus1, nullptr);
        for (int i = 0; i < 12; ++i) {
            const double beta = shapes.beta(i), error = std::pow(beta * h, 2);
            EXPECT_NEAR((plus[i] - minus[i]) / (2 * h) / beta, y1[i] / beta, error);
            EXPECT_NEAR((plus1[i] - minus1[i]) / (2 * h) / (beta * beta), y2[i] / (beta * beta), error);
        }
    }
}

TEST(Shapes, OfAProblemFollowItsBasis) {
    Problem p;
    p.beam.modes = 3;
    EXPECT_NEAR(Shapes::of(p).beta(0), 3.9266023120479, 1e-12);
    p.hub.drive = ConstantSpeed{1};
    EXPECT_NEAR(Shapes::of(p).beta(0), 1.8751040687120, 1e-12);
    p.beam.model = ModelKind::rigid;
    EXPECT_EQ(Shapes::of(p).count(), 0);
}

TEST(HubBeamShapes, StayWithinTheirBounds) {
    for (const double radius : {-0.7, -0.2, -0.1, 0.0, 0.3})
        for (const double inertia : {0.0, 1e-3, 1.0}) {
            const Shapes shapes = Shapes::hub_beam(12, 1, radius, inertia);
            std::vector<double> y(12), y1(12), y2(12);
            for (int k = 0; k <= 500; ++k) {
                shapes.evaluate(k / 500.0, y.data(), y1.data(), y2.data());
                for (int i = 0; i < 12; ++i) {
                    const auto j = static_cast<std::size_t>(i);
                    const double beta = shapes.beta(i), most = shapes.bound(i) * (1 + 1e-12);
                    EXPECT_LE(std::fabs(y[j]), most);
                    EXPECT_LE(std::fabs(y1[j]), beta * most);
                    EXPECT_LE(std::fabs(y2[j]), beta * beta * most);
                }
            }
        }
}

}  // namespace
}  // namespace beamcam::sim
