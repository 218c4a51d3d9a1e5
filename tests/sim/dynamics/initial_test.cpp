// Initial states: equilibria and given coordinates.
#include "sim/dynamics/initial.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <optional>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

// The default system, `softer` times softer, with every length multiplied by `size` and the modulus and the stiffness
// of the contact such that weights bend it alike.
Problem scaled(ModelKind kind, InitialShape shape, double softer, double size) {
    Problem p;
    p.beam.model = kind;
    p.beam.modes = 6;
    p.beam.length *= size;
    p.beam.area *= std::pow(size, 2);
    p.beam.second_moment *= std::pow(size, 4);
    p.beam.youngs_modulus *= size / softer;
    p.cam->centre = size * p.cam->centre;
    p.cam->radius *= size;
    p.cam->eccentricity *= size;
    p.cam->speed = 0;
    p.contact.stiffness = 1e8 * std::pow(size, 1.5);
    p.initial.angle = 0.3;
    p.initial.shape = shape;
    return p;
}

// Dimensionless hub angle and coordinates; nothing if no equilibrium is found.
std::optional<Vector> equilibrium(ModelKind kind, InitialShape shape, double softer, double size) {
    const Problem p = scaled(kind, shape, softer, size);
    System system(p);
    std::optional<InitialState> state;
    try {
        state = initial_state(system);
    } catch (const StepFailure&) {
        return std::nullopt;
    }
    system.set_state(0, state->y.data());
    Vector out(system.coordinates());
    out[0] = system.model().hub_angle();
    for (int i = 1; i < out.size(); ++i)
        out[i] = state->y[static_cast<std::size_t>(i)] / (kind == ModelKind::exact ? 1 : size);
    return out;
}

TEST(Equilibrium, IsTheSameForABeamOfAMillimetreAndOfAHundredMetres) {
    SKIP_UNDER_SANITIZERS();
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::paper, ModelKind::second_order, ModelKind::exact})
        for (const InitialShape shape : {InitialShape::static_equilibrium, InitialShape::resting})
            for (const double softer : {1.0, 100.0, 1000.0}) {
                const auto metre = equilibrium(kind, shape, softer, 1);
                for (const double size : {1e-3, 1e2}) {
                    const auto other = equilibrium(kind, shape, softer, size);
                    ASSERT_EQ(metre.has_value(), other.has_value()) << name(kind) << " " << softer << " " << size;
                    if (metre) {
                        EXPECT_LT((*metre - *other).cwiseAbs().maxCoeff(), 1e-9)
                            << name(kind) << " " << softer << " " << size;
                    }
                }
                if (shape == InitialShape::static_equilibrium) {
                    ASSERT_TRUE(metre.has_value()) << name(kind) << " " << softer;
                    EXPECT_NEAR((*metre)[0], 0.3, 1e-9) << name(kind) << " " << softer;
                }
            }
}

TEST(Equilibrium, ThatDoesNotExistIsNotFoundInABeamOfAMillimetre) {
    // Too soft to rest on the cam.
    for (const double size : {1.0, 1e-3, 1e2})
        EXPECT_FALSE(equilibrium(ModelKind::first_order, InitialShape::resting, 1e5, size).has_value()) << size;
}

// A beam without a cam, on a hub held at this angle; load: mgL²/(EI).
Problem held_beam(ModelKind kind, int modes, double load, double angle) {
    Problem p;
    p.beam.model = kind;
    p.beam.modes = modes;
    p.beam.youngs_modulus = p.beam.line_density() * p.gravity / (load * p.beam.second_moment);  // L = 1 m
    p.cam.reset();
    p.hub.drive = ConstantSpeed{};
    p.initial.shape = InitialShape::static_equilibrium;
    p.initial.angle = angle;
    return p;
}

double tip_deflection(const Model& model) {
    BeamPoint tip, root;
    model.point(model.length(), tip);
    model.point(0, root);
    return dot(tip.r - root.r, perp(unit(model.hub_angle())));
}

// Tip deflections over the length by shooting: EI ψ″ = ρAg(L − s) cos ψ, ψ(0) = θ, ψ′(L) = 0, integrated to 1e-12; of
// several solutions the one that grows out of the straight beam, whose bending moment has one sign.
TEST(Equilibrium, OfASoftBeamIsTheOneThatItsStraightFormLeadsTo) {
    struct Reference {
        double load, angle, tip;
    };
    for (const auto& [load, angle, tip] : {Reference{17.4732206, 0.7, -0.8807306777},
                                           {17.4732206, 1.0, -0.8554404362},
                                           {17.4732206, 1.4, -0.7903889026},
                                           {34.946, 0.7, -0.8528044336},
                                           {116.488, 0, -0.9424482264}})
        for (const int modes : {12, 20}) {
            Problem p = held_beam(ModelKind::exact, modes, load, angle);
            System system(p);
            const InitialState state = initial_state(system);
            system.set_state(0, state.y.data());
            EXPECT_FALSE(state.unstable) << load << " " << angle;
            // Twelve shapes leave 1e-5 of a beam whose bend is concentrated at its root.
            EXPECT_NEAR(tip_deflection(system.model()), tip, modes == 20 ? 1e-7 : 2e-4) << load << " " << angle;
        }
}

// An upright beam buckles under its weight at mgL²/(EI) = 7.837347 (Greenhill 1881).
TEST(Equilibrium, OfAnUprightBeamIsStableBelowGreenhillsLoad) {
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order, ModelKind::exact})
        for (const int modes : {8, 20, 40}) {
            const double upright = 0.5 * std::numbers::pi;
            EXPECT_FALSE(initial_state(held_beam(kind, modes, 7.83, upright)).unstable) << name(kind) << modes;
            EXPECT_TRUE(initial_state(held_beam(kind, modes, 7.85, upright)).unstable) << name(kind) << modes;
            EXPECT_FALSE(initial_state(held_beam(kind, modes, 0.0035, 0.7)).unstable) << name(kind) << modes;
        }
}

// The problem whose motion begins where the given one is at an instant in flight. Rates of the shapes are differences
// of fourth order of channels.
Problem continued(const Problem& from, double at) {
    Problem p = from;
    const double h = 2e-5;
    const auto value = [&](const std::string& name) { return series(from, name.c_str(), {at}).front(); };
    p.initial.angle = value("theta");
    p.initial.angular_velocity = value("theta_dot");
    for (int i = 1; i <= from.beam.modes; ++i) {
        const std::string name = "q" + std::to_string(i);
        const auto q = series(from, name.c_str(), {at - 2 * h, at - h, at, at + h, at + 2 * h});
        p.initial.q.push_back(q[2]);
        p.initial.q_dot.push_back((q[0] - 8 * q[1] + 8 * q[3] - q[4]) / (12 * h));
    }
    if (p.cam) p.cam->phase -= p.cam->speed * at;  // clockwise
    return p;
}

TEST(GivenShapes, ContinueAMotionFromAnyInstantInFlight) {
    for (const auto& [kind, basis] :
         {std::pair{ModelKind::first_order, Basis::hub_beam}, std::pair{ModelKind::first_order, Basis::cantilever},
          std::pair{ModelKind::second_order, Basis::automatic}, std::pair{ModelKind::exact, Basis::automatic}}) {
        Problem whole;
        whole.beam.model = kind;
        whole.beam.basis = basis;
        whole.cam->speed = 5;
        whole.solver.rtol = 1e-10;
        const double at = 0.32;  // after the first impact
        ASSERT_GT(series(whole, "gap", {at}).front(), 1e-4) << name(kind);
        const Problem rest = continued(whole, at);
        EXPECT_TRUE(validate(rest).empty()) << name(kind);
        const std::vector<double> later = {0.01, 0.05, 0.1};
        std::vector<double> instants;
        for (const double t : later) instants.push_back(at + t);
        for (const char* channel : {"theta", "theta_dot", "tip_deflection", "q2"}) {
            const auto expected = series(whole, channel, instants), got = series(rest, channel, later);
            for (std::size_t i = 0; i < later.size(); ++i)
                EXPECT_NEAR(got[i], expected[i], 1e-5 * (1 + std::fabs(expected[i])))
                    << name(kind) << " " << name(basis) << " " << channel << " after " << later[i] << " s";
        }
    }
}

TEST(GivenShapes, LeaveTheHubAtItsAngle) {
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order, ModelKind::exact}) {
        Problem p = falling_beam(kind);
        p.initial.angular_velocity = 0.25;
        p.initial.q = {1e-3, -2e-4};
        p.initial.q_dot = {0.1};
        EXPECT_NEAR(series(p, "theta", {0}).front(), kQuarterTurn, 1e-15) << name(kind);
        EXPECT_NEAR(series(p, "theta_dot", {0}).front(), 0.25, 1e-12) << name(kind);
        EXPECT_DOUBLE_EQ(series(p, "q1", {0}).front(), 1e-3) << name(kind);
        EXPECT_DOUBLE_EQ(series(p, "q2", {0}).front(), -2e-4) << name(kind);
    }
}

}  // namespace
}  // namespace beamcam::sim::testing
