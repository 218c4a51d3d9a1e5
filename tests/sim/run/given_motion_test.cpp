// A rigid beam on a prescribed hub: its motion is given, and so are the forces of compliant contact. Their integrals
// are the only unknowns of a run.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "sim/base/numerics.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

constexpr double kGivenEnd = 1.2, kStiffness = 1e6, kFriction = 0.3, kSlipSpeed = 0.02;
constexpr int kPoints = 20000;  // of the quadrature

// The eccentric disc lifts by up to 8 mm into the beam, above its centre line, twice in the run.
Problem pressed_at(const Drive& drive, DampingLaw damping, Method method) {
    Problem p;
    p.beam.model = ModelKind::rigid;
    p.hub.drive = drive;
    p.cam->speed = 10;
    p.contact.stiffness = kStiffness;
    p.contact.damping = damping;
    p.contact.restitution = 0.2;
    p.contact.friction = CoulombFriction{kFriction, kSlipSpeed};
    p.initial.angle = 0.47;
    p.solver.method = method;
    return p;
}

struct Touch {
    double gap, rate, slip, x;
};
Touch touch_at(const Problem& p, const HubMotion& hub, double t) {
    const double psi = p.cam->phase - p.cam->speed * t, e = p.cam->eccentricity;
    const Vec2 arm = e * unit(psi), centre = p.cam->centre + arm, speed = -p.cam->speed * perp(arm);
    const Vec2 along = unit(hub.angle), normal = perp(along);
    const double x = dot(centre, along);
    return {-dot(centre, normal) - p.cam->radius, hub.rate * x - dot(speed, normal),
            -dot(speed, along) - p.cam->speed * p.cam->radius, x};
}

struct Truth {
    double start = 0, end = 0, impulse_n = 0, impulse_t = 0, peak = 0, lost = 0, moment_work = 0;
};

// From the touch to the release, by the trapezoidal rule in a variable in which the integrands are flat at the ends.
Truth integrated(const Problem& p, const DriveLaw& law, double start, double end) {
    const double approach = -touch_at(p, law.motion(start), start).rate;
    const double damping = damping_factor(p.contact.damping, p.contact.restitution);
    Truth out{start, end};
    for (int k = 1; k < kPoints; ++k) {
        const double s = static_cast<double>(k) / kPoints, r = s * (1 - s);
        const double t = start + (end - start) * s * s * s * (10 - 15 * s + 6 * s * s);
        const double dt = (end - start) * 30 * r * r / kPoints;
        const HubMotion hub = law.motion(t);
        const Touch c = touch_at(p, hub, t);
        const double depth = std::max(0.0, -c.gap);
        const double n = std::max(0.0, kStiffness * std::pow(depth, 1.5) * (1 - damping * c.rate / approach));  // (S30)
        const double f = -kFriction * n * std::tanh(c.slip / kSlipSpeed);                                       // (S34)
        out.impulse_n += n * dt;
        out.impulse_t += f * dt;
        out.peak = std::max(out.peak, n);
        out.lost -= (n * c.rate + f * c.slip) * dt;
        out.moment_work += n * c.x * hub.rate * dt;
    }
    return out;
}

std::vector<Truth> truth_of(const Problem& p, const DriveLaw& law) {
    const auto gap = [&](double t) { return touch_at(p, law.motion(t), t).gap; };
    std::vector<Truth> out;
    std::optional<double> start;
    for (int k = 1; k <= 1000; ++k) {
        const double before = kGivenEnd * (k - 1) / 1000, now = kGivenEnd * k / 1000;
        if (gap(before) > 0 && gap(now) <= 0) start = find_root(gap, before, now);
        if (gap(before) <= 0 && gap(now) > 0) out.push_back(integrated(p, law, *start, find_root(gap, before, now)));
    }
    return out;
}

const Drive kDrives[] = {ConstantSpeed{0}, ConstantSpeed{-0.01}, SpinUp{-0.02, 0.7},
                         AngleTable{{0, 0.3, 0.8, 1.2}, {0.47, 0.466, 0.471, 0.469}}};

TEST(GivenMotion, HasTheImpulsesAndTheBalanceOfTheGivenForces) {
    for (const Drive& drive : kDrives)
        for (const DampingLaw damping : {DampingLaw::none, DampingLaw::lankarani_nikravesh, DampingLaw::hunt_crossley})
            for (const Method method : {Method::automatic, Method::rk8, Method::cvode_adams}) {
                const Problem p = pressed_at(drive, damping, method);
                const DriveLaw law(drive, p.initial.angle);
                const std::vector<Truth> truth = truth_of(p, law);
                Request request;
                request.tables.push_back({{kGivenEnd}, {channel("work_drive")}});
                const Result r = simulate(p, request);
                const auto what = fmt::format("drive {}, {}, {}", drive.index(), name(damping), name(method));
                const double tolerance = 10 * p.solver.rtol;
                ASSERT_EQ(truth.size(), 2u) << what;
                ASSERT_EQ(r.impacts.size(), 2u) << what;
                EXPECT_LT(r.energy_residual_max, tolerance * r.energy_scale) << what;
                const HubMotion first = law.motion(0), last = law.motion(kGivenEnd);
                const double mass = p.beam.line_density() * p.beam.length, length = p.beam.length;
                double work = 0.5 * p.gravity * mass * length * (std::sin(last.angle) - std::sin(first.angle)) +
                              mass * length * length / 6 * (last.rate * last.rate - first.rate * first.rate);
                for (std::size_t i = 0; i < 2; ++i) {
                    const Impact& found = r.impacts[i];
                    const Truth& given = truth[i];
                    const double energy = kStiffness * std::pow(found.penetration_peak, 2.5) / 2.5;
                    EXPECT_NEAR(found.t_start, given.start, 1e-13) << what;
                    EXPECT_NEAR(*found.t_end, given.end, 1e-13) << what;
                    EXPECT_NEAR(found.impulse_n, given.impulse_n, tolerance * given.impulse_n) << what;
                    EXPECT_NEAR(found.impulse_t, given.impulse_t, tolerance * given.impulse_n) << what;
                    EXPECT_NEAR(*found.force_peak, given.peak, 1e-6 * given.peak) << what;  // (S59)
                    EXPECT_NEAR(found.energy_lost, given.lost, tolerance * (energy + given.lost)) << what;
                    work -= given.moment_work;
                }
                EXPECT_NEAR(r.tables[0].values[0][0], work, tolerance * (r.energy_scale + std::fabs(work))) << what;
            }
}

// A rigid beam that rests on a round cam does not move while a torque changes the force between them.
Problem resting_under(double share, double friction) {
    Problem p;
    p.beam.model = ModelKind::rigid;
    p.cam->eccentricity = 0;
    p.cam->speed = -3;
    p.contact.model = ContactModel::restitution;
    p.contact.friction = CoulombFriction{friction, 0.01};
    p.initial.shape = InitialShape::resting;
    const double slope = std::asin(p.cam->radius / p.cam->centre.x);
    const double moment = 0.5 * p.beam.line_density() * p.beam.length * p.beam.length * p.gravity * std::cos(slope);
    p.hub.drive = HarmonicTorque{share * moment, 200, 0};
    return p;
}

TEST(GivenMotion, RestingBeamsLoseWhatTheMeanForceRubsOff) {
    for (const Method method : {Method::automatic, Method::rk8})
        for (const double rtol : {1e-8, 1e-11}) {
            const auto loss = [&](double share) {
                Problem p = resting_under(share, 0.3);
                p.solver.method = method;
                set_tolerance(p, rtol);
                return series(p, "loss_friction", {0.5}).front();
            };
            EXPECT_NEAR(loss(0.5), loss(0), 1e-6 * loss(0)) << name(method) << rtol;
        }
}

TEST(GivenMotion, RestingBeamsLeaveTheCamInEachPeriodOfATorqueThatLiftsThem) {
    for (const double share : {0.999, 1.0005})
        EXPECT_EQ(run(resting_under(share, 0), 0.5).impacts.size(), share < 1 ? 1u : 101u) << share;
}

// Without gravity nothing in a flight limits the steps.
TEST(GivenMotion, MeetsAFastCamOnceInEachOfItsTurns) {
    for (const Method method : {Method::automatic, Method::rk8})
        for (const double speed : {20.0, 200.0}) {
            Problem p = pressed_at(ConstantSpeed{0}, DampingLaw::none, method);
            p.gravity = 0;
            p.cam->speed = speed;
            EXPECT_EQ(run(p, 20 * std::numbers::pi / speed).impacts.size(), 10u) << name(method) << " " << speed;
        }
}

}  // namespace
}  // namespace beamcam::sim::testing
