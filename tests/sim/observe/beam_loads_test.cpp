// Moments, stresses, the force of the pivot and the power of the drive against closed forms.
#include <cmath>
#include <numbers>

#include "sim/base/numerics.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

using std::numbers::pi;

double at(const Problem& problem, const char* name, double t) { return series(problem, name, {t})[0]; }

Problem held_beam(ModelKind model, double angle, int modes = 2) {
    Problem p = falling_beam(model, Basis::automatic, modes);
    p.hub.drive = ConstantSpeed{0};
    p.initial.angle = angle;
    p.initial.shape = InitialShape::static_equilibrium;
    return p;
}

double mass(const Problem& p) { return p.beam.line_density() * p.beam.length; }
double weight(const Problem& p) { return mass(p) * p.gravity; }

// The stiff beam bends by less than 1e-6 of its length, which changes the lever of the weight as much.
TEST(BeamLoads, OfAHeldBeamAreThoseOfItsWeight) {
    for (const ModelKind model : {ModelKind::rigid, ModelKind::first_order, ModelKind::second_order, ModelKind::exact})
        for (const double angle : {0.0, 0.7, 2.5}) {
            SCOPED_TRACE(name(model));
            Problem p = held_beam(model, angle);
            p.beam.youngs_modulus *= 1e3;
            p.hub.radius = 0.1;
            const double moment = -0.5 * weight(p) * p.beam.length * std::cos(angle);
            const SectionProperties section = section_properties(p.beam);
            EXPECT_NEAR(at(p, "root_moment", 0.01), moment, 1e-6 * weight(p));
            EXPECT_NEAR(at(p, "stress_max", 0.01), std::fabs(moment) * section.c_max / section.second_moment,
                        1e-6 * weight(p) * section.c_max / section.second_moment);
            EXPECT_EQ(at(p, "stress_x", 0.01), 0);
            EXPECT_NEAR(at(p, "pivot_force", 0.01), weight(p), 1e-6 * weight(p));
            EXPECT_NEAR(at(p, "pivot_angle", 0.01), pi / 2, 1e-6);
            EXPECT_NEAR(at(p, "tip_acceleration", 0.01), 0, 1e-6 * p.gravity);
            EXPECT_EQ(at(p, "drive_power", 0.01), 0);
        }
}

TEST(BeamLoads, StressIsThatOfTheOutermostFibre) {
    Problem p = held_beam(ModelKind::first_order, 0);
    p.beam.length = 0.3;
    p.beam.material = Material::steel;
    p.beam.section = Rectangle{0.025, 0.003};
    const double bh2 = 0.025 * 0.003 * 0.003, q = 7850 * 0.025 * 0.003 * 9.81;
    EXPECT_NEAR(at(p, "stress_max", 0.01), 0.5 * q * 0.09 * 6 / bh2, 1e-4 * q * 0.09 * 3 / bh2);
    p.beam.section = CustomSection{7.5e-5, 5.625e-11, 0.002};
    EXPECT_NEAR(at(p, "stress_max", 0.01), 0.5 * q * 0.09 * 0.002 / 5.625e-11, 1e-4 * q * 0.045 * 0.002 / 5.625e-11);
    p.beam.section.reset();
    p.beam.area = 7.5e-5;
    p.beam.second_moment = 5.625e-11;
    p.beam.depth = 0.005;  // of an unknown section half the depth is the distance of the outermost fibre
    EXPECT_NEAR(at(p, "stress_max", 0.01), 0.5 * q * 0.09 * 0.0025 / 5.625e-11, 1e-4 * q * 0.045 * 0.0025 / 5.625e-11);
}

TEST(BeamLoads, OfARotatingRigidBeamAreCentrifugalForceAndWeight) {
    Problem p = held_beam(ModelKind::rigid, 0.3);
    p.initial.shape = InitialShape::straight;
    p.hub.radius = 0.2;
    p.hub.inertia = 0.3;
    p.hub.drive = ConstantSpeed{3};
    const double t = 0.4, theta = 0.3 + 3 * t, arm = 0.2 + 0.5 * p.beam.length;
    const Vec2 force = -mass(p) * arm * 9 * unit(theta) + Vec2{0, weight(p)};
    EXPECT_NEAR(at(p, "pivot_force", t), norm(force), 1e-12 * norm(force));
    EXPECT_NEAR(at(p, "pivot_angle", t), std::atan2(force.y, force.x), 1e-12);
    EXPECT_NEAR(at(p, "tip_acceleration", t), 9 * (0.2 + p.beam.length), 1e-12);
    EXPECT_NEAR(at(p, "drive_power", t), 3 * weight(p) * arm * std::cos(theta), 1e-12);
    EXPECT_NEAR(at(p, "root_moment", t), -0.5 * weight(p) * p.beam.length * std::cos(theta), 1e-12);
}

// The hinged rod that falls: a quarter of its weight is on the hinge where it is horizontal and at rest; its largest
// moment is m g L cos θ/27, a third of the length from the hinge.
TEST(BeamLoads, OfAFallingRodAreThoseOfTheFallingChimney) {
    Problem p = falling_beam(ModelKind::rigid);
    p.initial.angle = 0;
    EXPECT_NEAR(at(p, "pivot_force", 0), 0.25 * weight(p), 1e-12);
    EXPECT_NEAR(at(p, "pivot_angle", 0), pi / 2, 1e-12);
    EXPECT_NEAR(at(p, "tip_acceleration", 0), 1.5 * p.gravity, 1e-12);
    p.initial.angle = 1;
    for (const double t : {0.0, 0.3}) {
        const double theta = at(p, "theta", t);
        const SectionProperties section = section_properties(p.beam);
        EXPECT_NEAR(at(p, "root_moment", t), 0, 1e-10);
        EXPECT_NEAR(at(p, "stress_max", t) * section.second_moment / section.c_max,
                    weight(p) * p.beam.length * std::cos(theta) / 27, 1e-7);
        EXPECT_NEAR(at(p, "stress_x", t), p.beam.length / 3, 1e-3);
    }
}

// θ̈ = −m g l cos θ/J, and M(0) moves the beam about its root.
TEST(BeamLoads, OfAFallingRodOnAHubAreThoseOfItsRotation) {
    Problem p = falling_beam(ModelKind::rigid);
    const double a = p.hub.radius = 0.2, length = p.beam.length;
    p.hub.inertia = 0.05;
    const double inertia = p.hub.inertia + mass(p) * (a * a + a * length + length * length / 3);
    for (const double t : {0.0, 0.3}) {
        const double cosine = std::cos(at(p, "theta", t));
        const double acceleration = -weight(p) * (a + 0.5 * length) * cosine / inertia;
        const double turning = mass(p) * (0.5 * a * length + length * length / 3) * acceleration;
        EXPECT_NEAR(at(p, "root_moment", t), -turning - 0.5 * weight(p) * length * cosine, 1e-9);
    }
}

// A hinge carries no moment, not even in a collision that bends the beam far.
TEST(BeamLoads, OfAHubWithoutInertiaHaveNoMomentAtTheRoot) {
    for (const ModelKind model : {ModelKind::zeroth_order, ModelKind::first_order, ModelKind::exact}) {
        Problem p = fixed_cam(model, 3);
        p.beam.youngs_modulus *= 1e-2;
        Request request;
        request.end_time = 0.6;
        request.extrema = {channel("root_moment"), channel("contact_force"), channel("tip_deflection")};
        const auto found = simulate(p, request).extrema;
        EXPECT_GT(found[1].max, 0) << name(model);
        EXPECT_GT(found[2].max - found[2].min, 0.05 * p.beam.length) << name(model);
        EXPECT_LT(std::max(found[0].max, -found[0].min), 1e-9) << name(model);
    }
}

// With q = ρAg cos θ and without an offset the beam is a lever on the disc, N x_c = ½ q L², and bends most over it.
TEST(BeamLoads, OfABeamThatRestsOnTheCamAreThoseOfALever) {
    for (const int modes : {1, 2, 8}) {
        Problem p = fixed_cam(ModelKind::first_order, modes);
        p.initial.shape = InitialShape::resting;
        set_tolerance(p, 1e-12);
        Request request;
        request.tables.push_back(
            {{0.01},
             {channel("theta"), channel("contact_x"), channel("contact_force"), channel("root_moment"),
              channel("stress_max"), channel("stress_x"), channel("pivot_force"), channel("pivot_angle")}});
        request.poses.push_back({{0.01}, 2});
        const Result r = simulate(p, request);
        const auto value = [&](std::size_t column) { return r.tables[0].values[column][0]; };
        const double theta = value(0), x = value(1), force = value(2);
        const double load = p.beam.line_density() * p.gravity * std::cos(theta), length = p.beam.length;
        EXPECT_NEAR(force * x, 0.5 * load * length * length, 1e-4 * force * x) << modes;
        EXPECT_NEAR(value(3), 0, 1e-5 * weight(p)) << modes;
        const double largest = 0.5 * load * (length - x) * (length - x);
        const SectionProperties section = section_properties(p.beam);
        EXPECT_NEAR(value(4) * section.second_moment / section.c_max, largest, 1e-4 * largest) << modes;
        EXPECT_NEAR(value(5), x, 1e-12) << modes;
        const Vec2 pivot = Vec2{0, weight(p)} - force * r.poses[0][0].nearest->normal;
        EXPECT_NEAR(value(6), norm(pivot), 1e-6 * norm(pivot)) << modes;
        EXPECT_NEAR(value(7), std::atan2(pivot.y, pivot.x), 1e-6) << modes;
    }
}

// One mode vibrates with small amplitude: M = EI(κ + ηκ̇), whatever the damping is called.
TEST(BeamLoads, OfADampedVibrationContainTheViscousPart) {
    for (const bool ratio : {false, true}) {
        Problem p = falling_beam(ModelKind::first_order, Basis::cantilever, 1);
        p.hub.drive = ConstantSpeed{0};
        p.gravity = 0;
        p.initial.q = {1e-5};
        const double omega = first_clamped_frequency(p.beam), eta = 0.2 / omega;
        if (ratio)
            p.beam.damping_ratio = {0.5 * eta * omega};
        else
            p.beam.kelvin_voigt = eta;
        const double t = 0.3 / omega, h = 1e-3 / omega;
        Request request;
        request.tables.push_back({{t}, {channel("root_moment")}});
        request.poses.push_back({{t - h, t, t + h}, 2});
        const Result r = simulate(p, request);
        const auto elastic = [&](std::size_t k) { return r.poses[0][k].moment.front(); };
        const double viscous = eta * (elastic(2) - elastic(0)) / (2 * h);
        EXPECT_GT(std::fabs(viscous), 0.03 * std::fabs(elastic(1)));
        EXPECT_NEAR(r.tables[0].values[0][0], elastic(1) + viscous, 1e-6 * std::fabs(elastic(1))) << ratio;
    }
}

// A clamped beam whose tip passes its straight position at the speed v in one mode bends until σ = v √(Eρ) c/r, in any
// mode: the kinetic energy has become bending energy (Hunt 1960). r is the radius of gyration √(I/A).
TEST(BeamLoads, StressOfAVibrationFollowsFromTheSpeedOfTheTip) {
    for (const std::size_t mode : {0u, 1u, 2u}) {
        Problem p = falling_beam(ModelKind::first_order, Basis::cantilever, 3);
        p.hub.drive = ConstantSpeed{0};
        p.gravity = 0;
        p.beam.section = Rectangle{0.025, 0.003};
        p.initial.angle = 0;
        p.initial.q_dot.assign(3, 0);
        p.initial.q_dot[mode] = 1e-4;
        Request request;
        request.end_time = 10 / first_clamped_frequency(p.beam);
        request.extrema = {channel("stress_max"), channel("tip_rate")};
        const Result r = simulate(p, request);
        const SectionProperties section = section_properties(p.beam);
        const double speed = std::max(r.extrema[1].max, -r.extrema[1].min);
        const double gyration = std::sqrt(section.second_moment / section.area);
        const double stress = speed * std::sqrt(p.beam.youngs_modulus * p.beam.density) * section.c_max / gyration;
        EXPECT_NEAR(r.extrema[0].max, stress, 1e-5 * stress) << mode;
    }
}

// The balance of moments of the hub, I_h θ̈ = τ + M(0) + a e × S with the shear force S on the hub, and that of the
// power: in flight and in contact, with an offset of the face and friction.
TEST(BeamLoads, MoveTheHubAsTheEquationsDo) {
    for (const ModelKind model : {ModelKind::first_order, ModelKind::second_order, ModelKind::exact}) {
        Problem p = fixed_cam(model, 3);
        p.beam.basis = Basis::hub_beam;
        p.hub.inertia = 0.02;
        p.hub.drive = ConstantTorque{-0.2};
        p.cam->speed = 5;
        p.contact.friction = CoulombFriction{0.3, 0.01};
        p.contact.offset = 0.02;
        set_tolerance(p, 1e-12);
        Request request;
        request.end_time = 0.45;
        const Result touched = simulate(p, request);
        const double touch = touched.impacts.at(0).t_start, h = 2e-7;
        for (const double t : {0.1, touch + 1e-4}) {
            request = {};
            request.tables.push_back(
                {{t - h, t, t + h},
                 {channel("theta_dot"), channel("root_moment"), channel("drive_power"), channel("contact_force")}});
            const auto v = simulate(p, request).tables[0].values;
            EXPECT_EQ(v[3][1] > 0, t > 0.2);
            const double torque = p.hub.inertia * (v[0][2] - v[0][0]) / (2 * h);
            const double scale = std::max(1.0, std::fabs(torque));
            EXPECT_NEAR(v[1][1] - 0.2, torque, 1e-4 * scale) << name(model) << " " << t;
            EXPECT_NEAR(v[2][1], -0.2 * v[0][1], 1e-12) << name(model) << " " << t;
        }
    }
}

TEST(BeamLoads, AccelerationOfTheTipIsTheSecondDerivativeOfItsPlace) {
    for (const ModelKind model : {ModelKind::zeroth_order, ModelKind::first_order, ModelKind::exact}) {
        const Problem p = falling_beam(model, Basis::automatic, 2);
        const double t = 0.25, h = 1e-5;
        Request request;
        request.tables.push_back({{t}, {channel("tip_acceleration")}});
        request.poses.push_back({{t - h, t, t + h}, 2});
        const Result r = simulate(p, request);
        const auto tip = [&](std::size_t k) { return r.poses[0][k].centreline.back(); };
        const double second = norm(tip(0) - 2 * tip(1) + tip(2)) * (1 / (h * h));
        EXPECT_NEAR(r.tables[0].values[0][0], second, 1e-4 * second) << name(model);
    }
}

// Gauss quadrature of the power over pieces of the motion without impacts is the work.
TEST(BeamLoads, PowerOfTheDriveIsTheRateOfItsWork) {
    for (const ModelKind model : {ModelKind::rigid, ModelKind::first_order, ModelKind::exact}) {
        for (const bool prescribed : {false, true}) {
            Problem p = falling_beam(model);
            if (prescribed)
                p.hub.drive = SpinUp{4, 0.5};
            else
                p.hub.drive = HarmonicTorque{2, 3, 0.4};
            p.hub.inertia = 0.01;
            const Quadrature rule = gauss_legendre(1500, 0.3);  // resolves the vibrations
            std::vector<double> times(rule.x.data(), rule.x.data() + rule.x.size());
            const std::vector<double> power = series(p, "drive_power", times);
            double work = 0;
            for (std::size_t k = 0; k < power.size(); ++k) work += rule.w[static_cast<Eigen::Index>(k)] * power[k];
            EXPECT_NEAR(work, at(p, "work_drive", 0.3), 1e-7 * std::fabs(work)) << name(model) << prescribed;
        }
    }
}

// Static equilibrium under a point force: the balance of forces needs no shapes, EI κ many.
TEST(BeamLoads, DoNotDependOnTheNumberOfShapesAtRest) {
    std::vector<double> stress;
    for (const int modes : {1, 12}) {
        Problem p = fixed_cam(ModelKind::first_order, modes);
        p.initial.shape = InitialShape::resting;
        stress.push_back(at(p, "stress_max", 0));
    }
    EXPECT_NEAR(stress[0], stress[1], 1e-4 * stress[1]);
}

// A stiff beam meets a soft contact slowly: it is always in equilibrium with its inertia, as a rigid one. The collision
// takes some hundredths of a second.
TEST(BeamLoads, OfAStiffBeamInASlowCollisionAreThoseOfARigidOne) {
    std::vector<double> times;
    for (int k = 0; k <= 450; ++k) times.push_back(1e-3 * k);
    const auto largest = [&](const Problem& p) { return std::ranges::max(series(p, "stress_max", times)); };
    Problem p = fixed_cam(ModelKind::rigid);
    p.contact.stiffness = 2e4;
    p.contact.exponent = 1;
    p.contact.damping = DampingLaw::none;
    const double rigid = largest(p);
    p.beam.model = ModelKind::first_order;
    p.beam.youngs_modulus *= 1e4;
    for (const int modes : {1, 4}) {
        p.beam.modes = modes;
        EXPECT_NEAR(largest(p), rigid, 0.02 * rigid) << modes;
    }
}

// A short touch: the bending energy U of the collision bounds the root mean square of the moment, √(2EIU/L), and so do
// the shapes the largest moment, within what a single bump makes of it.
TEST(BeamLoads, InAShortTouchAreThoseOfTheBendingEnergy) {
    for (const int modes : {4, 12}) {
        Problem p = fixed_cam(ModelKind::first_order, modes);
        p.contact.stiffness = 1e9;
        const double end = 0.375;
        const double energy = extremum(p, "energy_elastic", end).max;
        const SectionProperties section = section_properties(p.beam);
        const double moment = extremum(p, "stress_max", end).max * section.second_moment / section.c_max;
        const double mean = std::sqrt(2 * p.beam.bending_stiffness() * energy / p.beam.length);
        EXPECT_GT(moment, mean) << modes;
        EXPECT_LT(moment, 6 * mean) << modes;
    }
}

}  // namespace
}  // namespace beamcam::sim::testing
