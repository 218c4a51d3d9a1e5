// The equilibria that a run may start from.
#include "sim/dynamics/initial.hpp"

#include <gtest/gtest.h>

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

// Hub angle and coordinates without units; nothing when no equilibrium is found.
std::optional<Vector> equilibrium(ModelKind kind, InitialShape shape, double softer, double size) {
    const Problem p = scaled(kind, shape, softer, size);
    System system(p);
    std::optional<InitialState> state;
    try {
        state = initial_state(system);
    } catch (const StepFailure&) {
        return std::nullopt;
    }
    system.place(0, state->y.data());
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
    // Far too soft to lie on the cam.
    for (const double size : {1.0, 1e-3, 1e2})
        EXPECT_FALSE(equilibrium(ModelKind::first_order, InitialShape::resting, 1e5, size).has_value()) << size;
}

}  // namespace
}  // namespace beamcam::sim::testing
