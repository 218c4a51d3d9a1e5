// The beam models against Lagrange's equations of their energies and against their kinematics.
#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <vector>

#include "sim/base/linear_algebra.hpp"
#include "sim/beam/model.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

struct ModelCase {
    ModelKind model;
    Basis basis;
    int modes;
    double radius, inertia;
    double deflection;  // of the random states [m], [rad] for `exact`
};

std::string case_name(const ::testing::TestParamInfo<ModelCase>& info) {
    const ModelCase& c = info.param;
    return label(name(c.model)) + label(name(c.basis)) + std::to_string(c.modes) +
           (c.radius > 0   ? "Radius"
            : c.radius < 0 ? "NegativeRadius"
                           : "") +
           (c.inertia > 0 ? "Inertia" : "");
}

// A soft beam, so that elastic, inertial and gravity terms are of similar size.
Problem soft_beam(const ModelCase& c) {
    Problem p;
    p.cam.reset();
    p.beam.length = 1.3;
    p.beam.youngs_modulus = 2e8;
    p.beam.model = c.model;
    p.beam.basis = c.basis;
    p.beam.modes = c.modes;
    p.hub.radius = c.radius;
    p.hub.inertia = c.inertia;
    return p;
}

class Ladder : public ::testing::TestWithParam<ModelCase> {
  protected:
    void SetUp() override {
        problem = soft_beam(GetParam());
        model = make_model(problem);
    }
    State random() { return random_state(*model, dice, GetParam().deflection); }
    Problem problem;
    std::unique_ptr<Model> model;
    Dice dice{7};
};

class ConservativeLadder : public Ladder {};
// The frame is fixed to the hub; with hub-beam shapes it rotates relative to the hub.
class HubFrameLadder : public Ladder {};

TEST_P(ConservativeLadder, InertiaIsTheSecondDerivativeOfTheKineticEnergy) {
    for (int repeat = 0; repeat < 4; ++repeat) {
        const State s = random();
        const int n = model->size();
        const Matrix mass = mass_from_energy(*model, s.xi);
        force(*model, s);
        Matrix inverse = Matrix::Identity(n, n);
        for (int i = 0; i < n; ++i) model->solve(inverse.col(i).data());
        EXPECT_LT((inverse - inverse.transpose()).cwiseAbs().maxCoeff(), 1e-12 * inverse.cwiseAbs().maxCoeff());
        EXPECT_LT((inverse * mass - Matrix::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-9);
    }
}

// d/dt ∂T/∂ξ̇ − ∂T/∂ξ + ∂V/∂ξ = 0 with f = M ξ̈: f = −Ṁξ̇ + ∂T/∂ξ − ∂V/∂ξ.
TEST_P(ConservativeLadder, ForcesAreLagranges) {
    for (int repeat = 0; repeat < 4; ++repeat) {
        const State s = random();
        const int n = model->size();
        const Vector f = force(*model, s);
        const double h = 2e-4;
        const Vector momentum_growth =
            slope_at_zero([&](double e) { return Vector(mass_from_energy(*model, s.xi + e * s.rate) * s.rate); },
                          h / (1 + s.rate.norm()));
        Vector lagrange = -momentum_growth;
        for (int i = 0; i < n; ++i)
            lagrange[i] += scalar_slope_at_zero(
                [&](double e) {
                    const Vector xi = s.xi + e * Vector::Unit(n, i);
                    model->set(xi.data(), s.rate.data());
                    const Energies energies = model->energies();
                    return energies.kinetic - energies.gravity - energies.elastic;
                },
                h);
        EXPECT_LT((f - lagrange).cwiseAbs().maxCoeff(),
                  2e-8 * (f.cwiseAbs().maxCoeff() + momentum_growth.cwiseAbs().maxCoeff()))
            << "state " << repeat;
    }
}

TEST_P(HubFrameLadder, HeldHubTorqueIsTheReactionOfTheFullEquations) {
    ASSERT_EQ(model->hub_row()[1], 0);
    const State s = random();
    Vector f = force(*model, s), held = f;
    const double spin_up = 1.7;
    const double torque = model->solve_held(held.data(), spin_up);
    EXPECT_EQ(held[0], spin_up);
    // With this torque on a free hub, the hub has the same acceleration.
    f[0] += torque;
    model->solve(f.data());
    EXPECT_LT((f - held).cwiseAbs().maxCoeff(), 1e-9 * held.cwiseAbs().maxCoeff());
}

TEST_P(Ladder, JacobianIsTheDerivativeOfThePoint) {
    const int n = model->size();
    for (double share : {0.0, 0.31, 0.77, 1.0}) {
        const State s = random();
        const double x = share * problem.beam.length;
        Vector jx(n), jy(n), jchi(n);
        model->set(s.xi.data(), s.rate.data());
        model->jacobian(x, jx.data(), jy.data(), jchi.data());
        for (int i = 0; i < n; ++i) {
            const auto at = [&](double e) {
                const Vector xi = s.xi + e * Vector::Unit(n, i);
                model->set(xi.data(), s.rate.data());
                BeamPoint p;
                model->point(x, p);
                return Eigen::Vector4d(p.r.x, p.r.y, p.r1.x, p.r1.y);
            };
            const Eigen::Vector4d here = at(0), slope = slope_at_zero(at, 2e-4);
            EXPECT_NEAR(jx[i], slope[0], 1e-10) << x << " " << i;
            EXPECT_NEAR(jy[i], slope[1], 1e-10) << x << " " << i;
            // χ = arg r′
            const double turn = (here[2] * slope[3] - here[3] * slope[2]) / (here[2] * here[2] + here[3] * here[3]);
            EXPECT_NEAR(jchi[i], turn, 1e-9 * (1 + std::fabs(turn))) << x << " " << i;
        }
    }
}

TEST_P(Ladder, VelocityIsTheJacobianTimesTheRates) {
    const int n = model->size();
    for (double share : {0.0, 0.4, 1.0}) {
        const State s = random();
        model->set(s.xi.data(), s.rate.data());
        BeamPoint p;
        Vector jx(n), jy(n), jchi(n);
        model->point(share * problem.beam.length, p);
        model->jacobian(share * problem.beam.length, jx.data(), jy.data(), jchi.data());
        const double size = jx.norm() * s.rate.norm() + 1;
        EXPECT_NEAR(p.v.x, jx.dot(s.rate), 1e-13 * size);
        EXPECT_NEAR(p.v.y, jy.dot(s.rate), 1e-13 * size);
        const double turn = cross(p.r1, p.v1) / dot(p.r1, p.r1);
        EXPECT_NEAR(turn, jchi.dot(s.rate), 1e-12 * (1 + jchi.norm() * s.rate.norm()));
    }
}

TEST_P(Ladder, DerivativesAlongTheBeamAreConsistent) {
    const State s = random();
    model->set(s.xi.data(), s.rate.data());
    for (double share : {0.2, 0.55, 0.9}) {
        const double x = share * problem.beam.length;
        BeamPoint p;
        model->point(x, p);
        const auto at = [&](double e) {
            BeamPoint q;
            model->point(x + e, q);
            return (Eigen::Matrix<double, 6, 1>() << q.r.x, q.r.y, q.v.x, q.v.y, q.r1.x, q.r1.y).finished();
        };
        const Eigen::Matrix<double, 6, 1> slope = slope_at_zero(at, 1e-3);
        const double tolerance = 2e-8;  // sixth-order difference of the highest shape
        EXPECT_NEAR(p.r1.x, slope[0], tolerance);
        EXPECT_NEAR(p.r1.y, slope[1], tolerance);
        EXPECT_NEAR(p.v1.x, slope[2], 20 * tolerance);
        EXPECT_NEAR(p.v1.y, slope[3], 20 * tolerance);
        EXPECT_NEAR(p.r2.x, slope[4], 20 * tolerance);
        EXPECT_NEAR(p.r2.y, slope[5], 20 * tolerance);
    }
}

TEST_P(Ladder, HubAngleIsTheDirectionOfTheRoot) {
    State s = random();
    s.xi.tail(model->size() - 1) *= 1e-3;  // in mean-axis shapes the two agree to second order
    model->set(s.xi.data(), s.rate.data());
    BeamPoint root;
    model->point(0, root);
    EXPECT_NEAR(std::remainder(std::atan2(root.r1.y, root.r1.x) - model->hub_angle(), 2 * 3.14159265358979323846), 0,
                1e-8);
    const Vec2 along = unit(model->hub_angle());
    EXPECT_NEAR(root.r.x, problem.hub.radius * along.x, 1e-8);
    EXPECT_NEAR(root.r.y, problem.hub.radius * along.y, 1e-8);
}

TEST_P(Ladder, CloneIsIndependent) {
    const State s = random();
    const Vector before = force(*model, s);
    const std::unique_ptr<Model> other = model->clone();
    const State t = random();
    force(*other, t);
    BeamPoint p, q;
    model->point(0.5, p);
    other->point(0.5, q);
    EXPECT_NE(p.r, q.r);
    Vector again(model->size());
    ASSERT_TRUE(model->assemble(again.data()));
    EXPECT_EQ(again, before);
}

const ModelCase kConservative[] = {
    {ModelKind::rigid, Basis::automatic, 1, 0, 0, 0},
    {ModelKind::rigid, Basis::automatic, 1, -0.2, 0.3, 0},
    {ModelKind::zeroth_order, Basis::cantilever, 3, 0.2, 0.1, 0.05},
    {ModelKind::zeroth_order, Basis::hub_beam, 3, 0, 0, 0.05},
    {ModelKind::first_order, Basis::cantilever, 2, 0, 0, 0.05},
    {ModelKind::first_order, Basis::cantilever, 4, -0.3, 0.4, 0.02},
    {ModelKind::first_order, Basis::hub_beam, 4, 0, 0, 0.05},
    {ModelKind::first_order, Basis::hub_beam, 4, 0.25, 0, 0.02},
    {ModelKind::first_order, Basis::hub_beam, 3, -0.4, 0.2, 0.02},
    {ModelKind::second_order, Basis::cantilever, 3, 0, 0, 0.1},
    {ModelKind::second_order, Basis::cantilever, 3, 0.3, 0.2, 0.1},
    {ModelKind::second_order, Basis::hub_beam, 4, 0, 0, 0.1},
    {ModelKind::second_order, Basis::hub_beam, 3, 0.25, 0.1, 0.05},
    {ModelKind::second_order, Basis::hub_beam, 3, -0.4, 0, 0.05},
    {ModelKind::exact, Basis::automatic, 1, 0, 0, 0.8},
    {ModelKind::exact, Basis::automatic, 4, 0, 0, 0.8},
    {ModelKind::exact, Basis::automatic, 5, 0.3, 0.2, 0.8},
    {ModelKind::exact, Basis::automatic, 3, -0.4, 0, 0.8},
};
std::vector<ModelCase> whose_frame_is_the_hub() {
    std::vector<ModelCase> cases;
    std::ranges::copy_if(kConservative, std::back_inserter(cases),
                         [](const ModelCase& c) { return c.basis != Basis::hub_beam; });
    return cases;
}

INSTANTIATE_TEST_SUITE_P(Every, ConservativeLadder, ::testing::ValuesIn(kConservative), case_name);
INSTANTIATE_TEST_SUITE_P(Every, Ladder, ::testing::ValuesIn(kConservative), case_name);
INSTANTIATE_TEST_SUITE_P(Every, HubFrameLadder, ::testing::ValuesIn(whose_frame_is_the_hub()), case_name);
INSTANTIATE_TEST_SUITE_P(Paper, Ladder,
                         ::testing::Values(ModelCase{ModelKind::paper, Basis::cantilever, 3, 0.2, 0.1, 0.05}),
                         case_name);

// ---- relations between models ------------------------------------------------------------------

// The largest difference of accelerations between two models at a deflection scale.
double difference(ModelKind a, ModelKind b, Basis basis, double scale, double radius) {
    const std::unique_ptr<Model> first = make_model(soft_beam({a, basis, 3, radius, 0.05, 0})),
                                 second = make_model(soft_beam({b, basis, 3, radius, 0.05, 0}));
    Dice dice(3);
    const State s = random_state(*first, dice, scale);
    return (acceleration(*first, s) - acceleration(*second, s)).cwiseAbs().maxCoeff();
}

TEST(LadderRelations, SecondOrderTendsToFirstOrderQuadraticallyInTheDeflection) {
    for (const Basis basis : {Basis::cantilever, Basis::hub_beam})
        for (double radius : {0.0, 0.3, -0.3}) {
            const double coarse = difference(ModelKind::first_order, ModelKind::second_order, basis, 1e-3, radius),
                         fine = difference(ModelKind::first_order, ModelKind::second_order, basis, 1e-4, radius);
            EXPECT_GT(coarse, 0);
            EXPECT_NEAR(coarse / fine, 100, 15) << name(basis) << " " << radius;
        }
}

TEST(LadderRelations, ZerothOrderDiffersFromFirstOrderLinearlyInTheDeflection) {
    const double coarse = difference(ModelKind::first_order, ModelKind::zeroth_order, Basis::cantilever, 1e-4, 0.1),
                 fine = difference(ModelKind::first_order, ModelKind::zeroth_order, Basis::cantilever, 1e-5, 0.1);
    EXPECT_NEAR(coarse / fine, 10, 0.5);
}

TEST(LadderRelations, PaperIsFirstOrderWithoutGravityOfTheForeshorteningAtTheHorizontal) {
    // l = L cos θ is L at θ = 0, and u_f has no weight there: the two differ only by ½ cos θ qᵀGq.
    const ModelCase c{ModelKind::paper, Basis::cantilever, 3, 0.2, 0.1, 0};
    Problem p = soft_beam(c);
    p.gravity = 0;
    const std::unique_ptr<Model> paper = make_model(p);
    p.beam.model = ModelKind::first_order;
    const std::unique_ptr<Model> first = make_model(p);
    Dice dice(5);
    State s = random_state(*paper, dice, 0.02);
    s.xi[0] = 0;
    EXPECT_LT((acceleration(*paper, s) - acceleration(*first, s)).cwiseAbs().maxCoeff(),
              1e-9 * acceleration(*first, s).cwiseAbs().maxCoeff());
    s.xi[0] = 1;
    EXPECT_GT((acceleration(*paper, s) - acceleration(*first, s)).cwiseAbs().maxCoeff(),
              1e-6 * acceleration(*first, s).cwiseAbs().maxCoeff());
}

TEST(LadderRelations, PaperGainsEnergyByTheMissingStiffeningAndByNothingElse) {
    // Ė along its own motion is ξ̇·(f − f of Lagrange's equations). l = L cos θ for L is all that separates them, with
    // and without gravity; at θ = 0 nothing does. So the ledger of `paper` stays open by a number that no tolerance
    // closes.
    const ModelCase c{ModelKind::paper, Basis::cantilever, 3, 0.2, 0.1, 0};
    Problem weightless = soft_beam(c);
    weightless.gravity = 0;
    const std::unique_ptr<Model> paper = make_model(soft_beam(c)), floating = make_model(weightless);
    weightless.beam.model = ModelKind::first_order;
    const std::unique_ptr<Model> first = make_model(weightless);
    Dice dice(11);
    for (const double angle : {1.0, 0.3, 0.0}) {
        State s = random_state(*paper, dice, 0.02);
        s.xi[0] = angle;
        const double expected = s.rate.dot(force(*floating, s) - force(*first, s));
        for (Model* model : {paper.get(), floating.get()}) {
            const Vector turn = acceleration(*model, s);
            const double h = 1e-3 / (1 + s.rate.norm() + turn.norm() / s.rate.norm());
            const double growth = scalar_slope_at_zero(
                [&](double e) {
                    const Vector xi = s.xi + e * s.rate + 0.5 * e * e * turn, rate = s.rate + e * turn;
                    model->set(xi.data(), rate.data());
                    const Energies energies = model->energies();
                    return energies.kinetic + energies.gravity + energies.elastic;
                },
                h);
            const double scale = s.rate.cwiseAbs().dot(force(*first, s).cwiseAbs());
            EXPECT_NEAR(growth, expected, 1e-7 * scale) << angle;
        }
        EXPECT_TRUE(angle == 0 ? std::fabs(expected) < 1e-12 : std::fabs(expected) > 1e-6) << expected;
    }
}

TEST(LadderRelations, RigidIsEveryModelWithoutDeflection) {
    for (const ModelKind kind : {ModelKind::zeroth_order, ModelKind::first_order, ModelKind::paper,
                                 ModelKind::second_order, ModelKind::exact}) {
        const std::unique_ptr<Model> model = make_model(soft_beam({kind, Basis::automatic, 3, 0.2, 0.1, 0}));
        const std::unique_ptr<Model> rod = make_model(soft_beam({ModelKind::rigid, Basis::automatic, 1, 0.2, 0.1, 0}));
        State s{Vector::Zero(4), Vector::Zero(4)};
        s.xi[0] = 0.6;
        s.rate[0] = 2;
        model->set(s.xi.data(), s.rate.data());
        rod->set(s.xi.data(), s.rate.data());
        EXPECT_NEAR(model->energies().kinetic, rod->energies().kinetic, 1e-13) << name(kind);
        EXPECT_NEAR(model->energies().gravity, rod->energies().gravity, 1e-13) << name(kind);
        BeamPoint p, q;
        for (double x : {0.0, 0.7, 1.3}) {
            model->point(x, p);
            rod->point(x, q);
            EXPECT_LT(norm(p.r - q.r), 1e-14) << name(kind);
            EXPECT_LT(norm(p.v - q.v), 1e-13) << name(kind);
        }
    }
}

TEST(LadderRelations, BothBasesHaveTheSameStaticForce) {
    // EI w⁗ = −ρAg cos θ of the clamped rod: tip −ρAgL⁴/(8EI) cos θ; the shapes converge to it.
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order, ModelKind::exact}) {
        Problem p;
        p.cam.reset();
        p.beam.model = kind;
        p.beam.modes = 10;
        p.initial.shape = InitialShape::static_equilibrium;
        p.initial.angle = 0.3;
        p.hub.drive = ConstantSpeed{0};
        const Beam& b = p.beam;
        const double tip = -b.line_density() * p.gravity * std::cos(0.3) / (8 * b.bending_stiffness());
        EXPECT_NEAR(series(p, "tip_deflection", {0})[0], tip, 2e-4 * std::fabs(tip)) << name(kind);
        p.hub.drive = FreeDrive{};
        // Hinged–free shapes have no moment at the root: they converge to the clamped rod as 1/N only.
        const double share = kind == ModelKind::exact ? 2e-4 : 0.08;
        EXPECT_NEAR(series(p, "tip_deflection", {0})[0], tip, share * std::fabs(tip)) << name(kind) << ", free hub";
    }
}

// ---- damping -----------------------------------------------------------------------------------

// Eigenvalues of the damped, linearized equations with a positive imaginary part, slowest first.
std::vector<std::complex<double>> damped_modes(Model& model, bool held) {
    const int n = model.size(), skip = held ? 1 : 0, m = n - skip;
    Matrix damping(n, n);
    const Linearization linear = model.linearize();
    State s{Vector::Zero(n), Vector::Zero(n)};
    s.xi[0] = kQuarterTurn * 2;  // gravity, constant, is not left by the difference of forces
    for (int i = 0; i < n; ++i) {
        s.rate = Vector::Unit(n, i);
        const Vector forth = force(model, s);
        s.rate = -Vector::Unit(n, i);
        damping.col(i) = -0.5 * (forth - force(model, s));
    }
    Matrix companion = Matrix::Zero(2 * m, 2 * m);
    const auto part = [&](const Matrix& full) { return full.bottomRightCorner(m, m); };
    const Eigen::PartialPivLU<Matrix> inverse(part(linear.mass));
    companion.topRightCorner(m, m).setIdentity();
    companion.bottomLeftCorner(m, m) = -inverse.solve(Matrix(part(linear.stiffness)));
    companion.bottomRightCorner(m, m) = -inverse.solve(Matrix(part(damping)));
    std::vector<std::complex<double>> modes;
    for (const std::complex<double>& value : eigenvalues(companion))
        if (value.imag() > 1e-3) modes.push_back(value);
    std::sort(modes.begin(), modes.end(), [](auto a, auto b) { return std::abs(a) < std::abs(b); });
    return modes;
}

TEST(Damping, RatiosBelongToTheFreeModesInEveryBasis) {
    const std::vector<double> ratios{0.01, 0.2, 0.03, 0.7};
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order, ModelKind::exact})
        for (const Basis basis : {Basis::cantilever, Basis::hub_beam}) {
            Problem p = soft_beam({kind, basis, 4, 0.15, 0.02, 0});
            p.beam.damping_ratio = ratios;
            const auto modes = damped_modes(*make_model(p), false);
            ASSERT_EQ(modes.size(), 4u);
            for (std::size_t i = 0; i < 4; ++i)
                EXPECT_NEAR(-modes[i].real() / std::abs(modes[i]), ratios[i], 1e-8)
                    << name(kind) << " " << name(basis) << " " << i;
        }
}

TEST(Damping, RatiosBelongToTheClampedModesUnderAPrescribedDrive) {
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order, ModelKind::exact}) {
        Problem p = soft_beam({kind, Basis::automatic, 3, 0.15, 0.02, 0});
        p.hub.drive = ConstantSpeed{1};
        p.beam.damping_ratio = {0.05};
        for (const auto& mode : damped_modes(*make_model(p), true))
            EXPECT_NEAR(-mode.real() / std::abs(mode), 0.05, 1e-8) << name(kind);
    }
}

TEST(Damping, KelvinVoigtGrowsWithTheFrequency) {
    for (const Basis basis : {Basis::cantilever, Basis::hub_beam}) {
        Problem p = soft_beam({ModelKind::first_order, basis, 3, 0.1, 0.01, 0});
        p.beam.kelvin_voigt = 2e-3;
        for (const auto& mode : damped_modes(*make_model(p), false))
            EXPECT_NEAR(-mode.real(), 0.5 * 2e-3 * std::norm(mode), 1e-7 * std::norm(mode)) << name(basis);  // ζ = ηω/2
    }
}

TEST(Damping, TakesPowerOnlyFromTheVibration) {
    Problem p = soft_beam({ModelKind::first_order, Basis::cantilever, 3, 0.1, 0, 0});
    p.beam.damping_ratio = {0.1};
    const std::unique_ptr<Model> model = make_model(p);
    State s{Vector::Zero(4), Vector::Zero(4)};
    s.rate[0] = 5;
    force(*model, s);
    EXPECT_EQ(model->damping_power(), 0);
    s.rate[2] = -0.3;
    force(*model, s);
    EXPECT_GT(model->damping_power(), 0);
}

}  // namespace
}  // namespace beamcam::sim::testing
