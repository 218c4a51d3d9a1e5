#include "sim/beam/modal_model.hpp"

#include <cmath>

#include "sim/base/linear_algebra.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

// Length, mass and stiffness one: matrices are the published integrals themselves.
Problem unit_beam(int modes) {
    Problem p;
    p.cam.reset();
    p.beam.length = p.beam.area = p.beam.density = p.beam.youngs_modulus = p.beam.second_moment = 1;
    p.beam.modes = modes;
    p.beam.basis = Basis::cantilever;
    return p;
}

TEST(ModalMatrices, OfTheHubRadiusAreLinearInIt) {
    Problem p = unit_beam(5);
    const Shapes shapes = Shapes::of(p);
    const ModalMatrices zero = modal_matrices(p, shapes, Basis::cantilever);
    p.hub.radius = 0.7;
    const ModalMatrices m = modal_matrices(p, shapes, Basis::cantilever);
    EXPECT_LT((m.U - zero.U - 0.7 * zero.W).norm(), 1e-14);
    EXPECT_LT((m.D - zero.D - 0.7 * zero.G).norm(), 1e-11);
    EXPECT_NEAR(m.J, 1.0 / 3 + 0.7 + 0.49, 1e-15);
}

TEST(ModalMatrices, OfHubBeamShapesHaveNoCouplingAndIncludeTheTurnOfTheRoot) {
    Problem p = unit_beam(3);
    p.beam.basis = Basis::hub_beam;
    p.hub.radius = 0.2;
    p.hub.inertia = 0.05;
    const Shapes shapes = Shapes::of(p);
    const ModalMatrices m = modal_matrices(p, shapes, Basis::hub_beam);
    EXPECT_EQ(m.U.norm(), 0);
    const ModalMatrices plain = modal_matrices(p, shapes, Basis::cantilever);
    EXPECT_LT((m.M + p.hub.inertia * m.slope * m.slope.transpose() - Matrix::Identity(3, 3)).cwiseAbs().maxCoeff(),
              1e-12);
    EXPECT_LT((m.D - plain.D - p.hub.radius * m.S * m.slope * m.slope.transpose()).norm(), 1e-12);
    EXPECT_LT((m.G - plain.G - p.hub.radius * m.slope * m.slope.transpose()).norm(), 1e-12);
}

TEST(ModalMatrices, AreEmptyForTheRigidRod) {
    Problem p = unit_beam(2);
    p.beam.model = ModelKind::rigid;
    const ModalMatrices m = modal_matrices(p, Shapes::of(p), Basis::cantilever);
    EXPECT_EQ(m.U.size(), 0);
    EXPECT_NEAR(m.J, 1.0 / 3, 1e-16);
}

// ω√(ρAL⁴/EI) of the linearized equations, with a free hub or rotating at γ.
std::vector<double> frequencies(const Problem& p, double speed, bool held) {
    const std::unique_ptr<Model> model = make_model(p);
    const int n = model->size();
    const auto [mass, stiffness, centrifugal] = model->linearize();
    Matrix inertia = mass.bottomRightCorner(n - 1, n - 1);
    if (!held) inertia -= mass.bottomLeftCorner(n - 1, 1) * mass.topRightCorner(1, n - 1) / mass(0, 0);
    const Matrix elastic =
        stiffness.bottomRightCorner(n - 1, n - 1) + speed * speed * centrifugal.bottomRightCorner(n - 1, n - 1);
    const Vector squares = eigenmodes(elastic, inertia).omega_squared;
    std::vector<double> omega;
    for (int i = 0; i < n - 1; ++i) omega.push_back(std::sqrt(squares[i]));
    return omega;
}

TEST(Linearization, OfEveryModelConvergesToTheHingedFreeBeam) {
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order, ModelKind::exact}) {
        Problem p = unit_beam(10);
        p.beam.basis = Basis::automatic;
        p.beam.model = kind;
        EXPECT_NEAR(frequencies(p, 0, false)[0], 15.41820571698, 1e-8) << name(kind);
        EXPECT_NEAR(frequencies(p, 0, false)[1], 49.9648620318, 1e-5) << name(kind);
    }
}

TEST(Linearization, OfTheTurningBeamGivesThePublishedChordwiseFrequencies) {
    SKIP_UNDER_SANITIZERS();
    // Wright et al. 1982, flapwise; in the plane of rotation ω² is smaller by γ².
    const double flapwise[3][3] = {{3.681646817, 22.18101121, 61.841762588},
                                   {4.137319576, 22.614922015, 62.273184108},
                                   {5.585001421, 24.273349392, 63.966760493}};
    const double gamma[] = {1, 2, 4};
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order, ModelKind::exact}) {
        // Clamped shapes converge algebraically, Legendre polynomials exponentially.
        Problem p = unit_beam(kind == ModelKind::exact ? 14 : 40);
        p.beam.model = kind;
        for (int row = 0; row < 3; ++row) {
            const std::vector<double> omega = frequencies(p, gamma[row], true);
            for (int i = 0; i < 3; ++i) {
                const double tolerance = (kind == ModelKind::exact ? 5e-9 : 1e-8) * flapwise[row][i];
                EXPECT_NEAR(std::sqrt(std::pow(omega[static_cast<std::size_t>(i)], 2) + gamma[row] * gamma[row]),
                            flapwise[row][i], tolerance)
                    << name(kind) << ", gamma " << gamma[row] << ", mode " << i + 1;
            }
        }
    }
}

TEST(FirstOrder, LosesPositiveInertiaWithManyCantileverModesAndSaysSo) {
    // A light hub: the quadratic form J + qᵀ(M − D)q − UᵀM⁻¹U is small from the start, and D grows with the mode.
    Problem p = falling_beam(ModelKind::first_order, Basis::cantilever, 12);
    const std::unique_ptr<Model> model = make_model(p);
    State s{Vector::Zero(13), Vector::Zero(13)};
    EXPECT_NO_THROW(force(*model, s));
    s.xi[1] = -0.01;
    s.xi[2] = 0.01;
    EXPECT_THROW(force(*model, s), std::runtime_error);
}

}  // namespace
}  // namespace beamcam::sim::testing
