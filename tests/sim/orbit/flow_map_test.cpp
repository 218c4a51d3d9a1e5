// The tangent flow against differences of the motion itself, and the laws of volume and of reciprocal pairs.
#include "sim/orbit/flow_map.hpp"

#include "sim/base/linear_algebra.hpp"
#include "sim/orbit/multipliers.hpp"
#include "tests/sim/orbit/pressed_beam.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

// The default system with a fast cam.
Problem machine(ModelKind model, int modes, ContactModel contact) {
    Problem p;
    p.beam.model = model;
    if (modes > 0) p.beam.modes = modes;
    p.cam->speed = 12;
    p.contact.model = contact;
    p.contact.stiffness = 1e6;
    p.contact.restitution = 0.9;
    p.initial.angle = 0.6;
    p.solver.method = Method::automatic;
    set_tolerance(p, 1e-13);
    return p;
}

InitialState shifted(const InitialState& start, Eigen::Index i, double h) {
    InitialState moved = start;
    moved.y[static_cast<std::size_t>(i)] += h;
    return moved;
}

Vector end_state(const Problem& p, const InitialState& start, double duration) {
    const FlowMap map = flow_map(p, start, duration, false);
    const auto n = static_cast<Eigen::Index>(2 * System(p).coordinates());
    return Eigen::Map<const Vector>(map.end.y.data(), n);
}

struct MapCase {
    const char* name;
    Problem problem;
    double duration;
    double tolerance = 2e-7;  // of a row, besides the rounding of the motion over h
};

class FlowMapTest : public ::testing::TestWithParam<MapCase> {};

// Each column, in the units of its rows: a finite difference in one coordinate against the exact tangent.
TEST_P(FlowMapTest, DerivativeIsTheLimitOfDifferences) {
    const MapCase& c = GetParam();
    const InitialState start = initial_state(c.problem);
    const FlowMap map = flow_map(c.problem, start, c.duration, true);
    ASSERT_GE(map.touches.size(), 1u);
    const Matrix& exact = map.derivative;
    // Only the first column under a sanitizer, because the differences take long.
    for (Eigen::Index i = 0; i < (under_sanitizers() ? 1 : exact.cols()); ++i) {
        const double h = 1e-6 / std::max(1.0, exact.col(i).head(exact.rows() / 2).cwiseAbs().maxCoeff());
        const Vector column =
            slope_at_zero([&](double s) { return end_state(c.problem, shifted(start, i, s), c.duration); }, h);
        const Vector rows = exact.rowwise().norm();
        const double rounding = 20 * std::numeric_limits<double>::epsilon() / h;
        for (Eigen::Index r = 0; r < exact.rows(); ++r)
            EXPECT_NEAR(column[r], exact(r, i), (c.tolerance + rounding) * rows[r]) << "row " << r << ", column " << i;
    }
}

std::vector<MapCase> map_cases() {
    std::vector<MapCase> all;
    const auto add = [&](const char* name, Problem p, double duration) -> Problem& {
        all.push_back({name, std::move(p), duration});
        return all.back().problem;
    };
    using enum ModelKind;
    using enum ContactModel;
    add("RigidNewton", machine(rigid, 2, restitution), 2);
    add("RigidTorque", machine(rigid, 2, restitution), 1).hub.drive = ConstantTorque{-0.5};
    add("TwoModesNewton", machine(first_order, 2, restitution), 0.2);
    add("ThreeModesDampedNewton", machine(first_order, 3, restitution), 0.2).beam.damping_ratio = {0.02};
    add("ZerothOrderNewton", machine(zeroth_order, 2, restitution), 0.2);
    Problem& radius = add("HubRadiusNewton", machine(first_order, 2, restitution), 0.32);
    radius.hub.radius = 0.1;
    radius.hub.inertia = 0.02;
    Problem& clamped = add("CantileverNewton", machine(first_order, 2, restitution), 0.32);
    clamped.beam.basis = Basis::cantilever;
    clamped.hub.inertia = 0.05;
    clamped.beam.damping_ratio = {0.02};
    for (const ImpactLaw law : {ImpactLaw::newton, ImpactLaw::poisson, ImpactLaw::stronge}) {
        const char* names[] = {"FrictionNewton", "FrictionPoisson", "FrictionStronge"};
        Problem& rough = add(names[static_cast<int>(law)], machine(first_order, 2, restitution), 0.2);
        rough.contact.law = law;
        rough.contact.friction = CoulombFriction{0.3, 0.01};
        rough.contact.offset = 0.01;
    }
    add("RigidCompliant", machine(rigid, 2, compliant), 2);
    add("RigidConservative", machine(rigid, 2, compliant), 1.3).contact.damping = DampingLaw::none;
    add("TwoModesCompliant", machine(first_order, 2, compliant), 0.5);
    all[all.size() - 2].tolerance = 5e-6;  // the touch gives back all that it amplified
    Problem& friction = add("TwoModesCoulombOffset", machine(first_order, 2, compliant), 0.5);
    friction.contact.friction = CoulombFriction{0.3, 0.05};
    friction.contact.offset = 0.01;
    for (const int kind : {0, 1}) {
        const char* names[] = {"StickSlip", "StickSlipStaticLarger"};
        Problem& sticky = add(names[kind], machine(first_order, 2, compliant), 0.4);
        sticky.cam->speed = 0.5;  // so slow that the bristle catches, breaks away and catches again
        sticky.contact.offset = 0.05;
        sticky.contact.friction = StickSlipFriction{0.8, kind == 1 ? std::optional(0.9) : std::nullopt, 2e4};
    }
    all.back().tolerance = 2e-6;  // more steps, more rounding
    add("ExactNewton", machine(exact, 2, restitution), 0.2);
    add("ExactCompliant", machine(exact, 2, compliant), 0.4);
    for (const ModelKind model : {second_order, paper}) {  // motions by rk8 are less smooth functions of their start
        add(model == paper ? "PaperNewton" : "SecondOrderNewton", machine(model, 2, restitution), 0.2);
        all.back().tolerance = 1e-4;
    }
    Problem& rests = add("OneModeRestsOnTheCam", machine(first_order, 1, restitution), 0.3);
    rests.contact.restitution = 0.6;
    rests.hub.radius = 0.05;
    all.back().tolerance = 1e-4;
    all.push_back(all.back());
    all.back().name = "RestsWithASmallSlipSpeed";
    all.back().problem.contact.friction = CoulombFriction{0.1, 1e-7};
    return all;
}

std::string map_case_name(const ::testing::TestParamInfo<MapCase>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(All, FlowMapTest, ::testing::ValuesIn(map_cases()), map_case_name);

// det = r²ⁿ over n impacts, whatever gravity, torque and cam do between them.                             (S73)
TEST(FlowMapLaw, DeterminantOfARigidBeamIsThatOfItsImpacts) {
    const auto check = [](const Problem& p, double duration, std::size_t impacts) {
        const FlowMap map = flow_map(p, initial_state(p), duration, true);
        ASSERT_EQ(map.touches.size(), impacts);
        const double expected = std::pow(p.contact.restitution, 2.0 * static_cast<double>(impacts));
        EXPECT_NEAR(map.derivative.determinant() / expected, 1, 1e-9);
    };
    check(machine(ModelKind::rigid, 2, ContactModel::restitution), 1.8, 2);
    Problem pressed = PressedBeam().on_orbit(48);
    set_tolerance(pressed, 1e-13);
    check(pressed, 10 * 2 * std::numbers::pi / 48, 10);
    pressed.gravity = 1;
    check(pressed, 5 * 2 * std::numbers::pi / 48, 5);
}

// Conservative compliant contact preserves areas.
TEST(FlowMapLaw, DeterminantOfConservativeContactIsOne) {
    Problem p = machine(ModelKind::rigid, 2, ContactModel::compliant);
    p.contact.damping = DampingLaw::none;
    const FlowMap map = flow_map(p, initial_state(p), 1.3, true);
    ASSERT_GE(map.touches.size(), 1u);
    EXPECT_NEAR(map.derivative.determinant(), 1, 1e-9);
}

// ∂(ξ, ∂T/∂ξ̇)/∂(ξ, ξ̇): the inertia is quadratic in ξ, so central differences are exact.
Matrix canonical(Model& model, const std::vector<double>& y) {
    const Eigen::Index n = model.size();
    const Vector xi = Eigen::Map<const Vector>(y.data(), n), rate = Eigen::Map<const Vector>(y.data() + n, n);
    Matrix c = Matrix::Identity(2 * n, 2 * n);
    c.bottomRightCorner(n, n) = mass_from_energy(model, xi);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Vector step = 1e-2 * Vector::Unit(n, i);
        c.block(n, i, n, 1) =
            (mass_from_energy(model, xi + step) - mass_from_energy(model, xi - step)) * rate / (2 * 1e-2);
    }
    return c;
}

// With modes it is symplectic: with μ, 1/μ is an eigenvalue of the map in canonical coordinates, too.
TEST(FlowMapLaw, ConservativeContactHasReciprocalPairs) {
    Problem p = machine(ModelKind::first_order, 2, ContactModel::compliant);
    p.contact.damping = DampingLaw::none;
    const InitialState start = initial_state(p);
    const FlowMap map = flow_map(p, start, 0.4, true);
    ASSERT_GE(map.touches.size(), 1u);
    ASSERT_FALSE(map.end.phase.touching);
    System system(p);
    const Matrix m =
        canonical(system.model(), map.end.y) * map.derivative * canonical(system.model(), start.y).inverse();
    const Eigen::VectorXcd multipliers = eigenvalues(m);
    for (const std::complex<double> a : multipliers) {
        double nearest = 1e9;
        for (const std::complex<double> b : multipliers) nearest = std::min(nearest, std::abs(a * b - 1.0));
        EXPECT_LT(nearest, 1e-9) << a;
    }
}

double inertia_share(const Problem& p, const FlowMap& map) {
    System system(p);
    const Vector end = Eigen::Map<const Vector>(map.end.y.data(), system.coordinates());
    const auto inertia = [&](const Vector& xi) { return mass_from_energy(system.model(), xi).determinant(); };
    return inertia(end) / inertia(Vector::Zero(end.size()));
}

// With modes the volume is that of (ξ, ∂T/∂ξ̇), and damping takes 2Σζω from its rate.                        (S73)
TEST(FlowMapLaw, VolumeShrinksByImpactsAndDampingAlone) {
    for (const int modes : {1, 2})
        for (const double zeta : {0.0, 1e-3}) {
            Problem p = machine(ModelKind::first_order, modes, ContactModel::restitution);
            p.hub.radius = 0.05;
            p.beam.damping_ratio = {zeta};
            const double duration = 0.2;
            const FlowMap map = flow_map(p, initial_state(p), duration, true);
            ASSERT_GE(map.touches.size(), 2u);
            ASSERT_FALSE(map.end.phase.held);
            double damping = 0;
            for (int i = 0; i < modes; ++i) damping += 2 * zeta * System(p).model().frequency(i);
            const double expected =
                2 * static_cast<double>(map.touches.size()) * std::log(p.contact.restitution) - damping * duration;
            const double volume = std::log(std::fabs(map.derivative.determinant())) + std::log(inertia_share(p, map));
            EXPECT_NEAR(volume, expected, 1e-9 * std::fabs(expected)) << modes << " modes, ratio " << zeta;
        }
}

double log_product(const std::vector<std::complex<double>>& values) {
    double sum = 0;
    for (const auto& each : values) sum += std::log(std::abs(each));
    return sum;
}

// Over twenty turns of the unstable orbit the smaller multiplier, 5e-15, is below the rounding of the product.
TEST(FlowMapLaw, SmallMultipliersKeepTheDeterminant) {
    Problem pressed = PressedBeam().on_orbit(52);
    set_tolerance(pressed, 1e-13);
    const FlowMap map = flow_map(pressed, initial_state(pressed), 20 * 2 * std::numbers::pi / 52, true);
    ASSERT_EQ(map.touches.size(), 20u);
    const double expected = 40 * std::log(pressed.contact.restitution);
    EXPECT_GT(std::fabs(log_product(multipliers({map.derivative})) - expected), 0.01);
    EXPECT_NEAR(log_product(multipliers(map.factors)), expected, 1e-8);
    // With modes and damping.
    Problem p = machine(ModelKind::first_order, 2, ContactModel::restitution);
    p.hub.radius = 0.05;
    p.beam.damping_ratio = {1e-3};
    const double duration = 0.2;
    const FlowMap damped = flow_map(p, initial_state(p), duration, true);
    ASSERT_GE(damped.touches.size(), 2u);
    ASSERT_FALSE(damped.end.phase.held);
    double volume = 2 * static_cast<double>(damped.touches.size()) * std::log(p.contact.restitution);
    for (int i = 0; i < 2; ++i) volume -= 2 * 1e-3 * System(p).model().frequency(i) * duration;
    EXPECT_NEAR(log_product(multipliers(damped.factors)) + std::log(inertia_share(p, damped)), volume, 1e-8);
}

// Tangents may need many steps within one of the motion.
TEST(FlowMapFailure, TangentsCanBeInterrupted) {
    Problem p = machine(ModelKind::first_order, 8, ContactModel::restitution);
    const InitialState start = initial_state(p);
    const auto calls = [&](bool derivative) {
        long count = 0;
        flow_map(p, start, 0.1, derivative, [&](double) { return ++count > 0; });
        return count;
    };
    const long motion = calls(false), both = calls(true);
    EXPECT_GT(both, motion);
    long count = 0;
    EXPECT_THROW(flow_map(p, start, 0.1, true, [&](double) { return ++count < both; }), Interrupted);
}

}  // namespace
}  // namespace beamcam::sim::testing
