// The derivative of the flow by neighbouring motions: the laws of volume and of reciprocal pairs.
#include "sim/base/linear_algebra.hpp"
#include "sim/orbit/neighbours.hpp"
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

// The motion and its derivative, in SI units.
struct Derived {
    FlowMap map;
    Matrix derivative;
};
Derived derived(const Problem& p, double duration) {
    const InitialState start = initial_state(p);
    Derived out{flow_map(p, start, duration), {}};
    const Vector scale = (motion_size(p, out.map, start) / difference_units(p).array()).matrix();
    const Neighbours neighbours(p, scale, Differences::extrapolated, {});
    const Eigen::Index n = scale.size() - kMemories;
    const Vector rows = scale.head(n);
    const Matrix basis = Matrix::Identity(scale.size(), n);
    const Matrix quotients = neighbours.along(0, start, duration, out.map, basis).topRows(n);
    out.derivative = rows.asDiagonal() * quotients * rows.cwiseInverse().asDiagonal();
    return out;
}

constexpr double kLaw = 1e-6;  // of four neighbours; most laws hold to 1e-8

// det = r²ⁿ over n impacts, whatever gravity, torque and cam do between them.                             (S73)
TEST(FlowMapLaw, DeterminantOfARigidBeamIsThatOfItsImpacts) {
    const auto check = [](const Problem& p, double duration, std::size_t impacts) {
        const auto [map, derivative] = derived(p, duration);
        ASSERT_EQ(map.touches.size(), impacts);
        const double expected = std::pow(p.contact.restitution, 2.0 * static_cast<double>(impacts));
        EXPECT_NEAR(derivative.determinant() / expected, 1, kLaw);
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
    const auto [map, derivative] = derived(p, 1.3);
    ASSERT_GE(map.touches.size(), 1u);
    EXPECT_NEAR(derivative.determinant(), 1, kLaw);
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
    const auto [map, derivative] = derived(p, 0.4);
    ASSERT_GE(map.touches.size(), 1u);
    ASSERT_FALSE(map.end.phase.touching);
    System system(p);
    const Matrix m = canonical(system.model(), map.end.y) * derivative * canonical(system.model(), start.y).inverse();
    const Eigen::VectorXcd multipliers = eigenvalues(m);
    for (const std::complex<double> a : multipliers) {
        double nearest = 1e9;
        for (const std::complex<double> b : multipliers) nearest = std::min(nearest, std::abs(a * b - 1.0));
        EXPECT_LT(nearest, kLaw) << a;
    }
}

// With modes the volume is that of (ξ, ∂T/∂ξ̇), and damping takes 2Σζω from its rate.                        (S73)
TEST(FlowMapLaw, VolumeShrinksByImpactsAndDampingAlone) {
    for (const int modes : {1, 2})
        for (const double zeta : {0.0, 1e-3}) {
            Problem p = machine(ModelKind::first_order, modes, ContactModel::restitution);
            p.hub.radius = 0.05;
            p.beam.damping_ratio = {zeta};
            const double duration = 0.2;
            const auto [map, derivative] = derived(p, duration);
            ASSERT_GE(map.touches.size(), 2u);
            ASSERT_FALSE(map.end.phase.held);
            double damping = 0;
            for (int i = 0; i < modes; ++i) damping += 2 * zeta * System(p).model().frequency(i);
            const double expected =
                2 * static_cast<double>(map.touches.size()) * std::log(p.contact.restitution) - damping * duration;
            System system(p);
            const auto inertia = [&](const InitialState& at) {
                return mass_from_energy(system.model(), Eigen::Map<const Vector>(at.y.data(), 1 + modes)).determinant();
            };
            const double volume =
                std::log(std::fabs(derivative.determinant()) * inertia(map.end) / inertia(initial_state(p)));
            EXPECT_NEAR(volume, expected, kLaw * std::fabs(expected)) << modes << " modes, ratio " << zeta;
        }
}

}  // namespace
}  // namespace beamcam::sim::testing
