// RigidMotion against Run, impact by impact, and against closed forms.
#include "sim/sweep/rigid_motion.hpp"

#include <cmath>
#include <numbers>

#include "sim/base/numerics.hpp"
#include "sim/sweep/sampler.hpp"
#include "sim/sweep/sweep_point.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

Problem rigid_newton(double speed, double eccentricity, double restitution) {
    Problem p;
    p.beam.model = ModelKind::rigid;
    p.contact.model = ContactModel::restitution;
    p.contact.restitution = restitution;
    p.cam->speed = speed;
    p.cam->eccentricity = eccentricity;
    p.solver.rtol = 1e-13;
    p.solver.atol = 1e-15;
    p.initial.angle = 0.6;
    return p;
}

Sampling first_turns(double turns) {
    Sampling s;
    s.transient.turns = 0;
    s.keep.turns = turns;
    return s;
}

// The largest difference of two samples; that of cam phases on the circle. Without a rebound rounding decides whether
// the contact lasts or is chatter that has ended.
double difference(const MotionSample& a, const MotionSample& b, double restitution) {
    double most = 0;
    for (std::size_t c = 0; c < (restitution > 0 ? kDuration : kNormalAfter); ++c) {
        double off = std::fabs(a[c] - b[c]);
        if (c == kCamPhase) off = std::min(off, std::fabs(1 - off));
        if (std::isnan(a[c]) && std::isnan(b[c])) off = 0;
        if (!(off <= most)) most = off;
    }
    return most;
}

// Compares samples one by one until rounding differences have grown; returns the number compared.
int expect_same(const Problem& p, const Sampling& s) {
    constexpr double kGrown = 1e-9, kSame = 1e-5;  // one impact does not multiply by more than their ratio
    EXPECT_TRUE(RigidMotion::applies(p, s));
    const SampledMotion fast = RigidMotion(p, s, nullptr).follow({}), slow = sample_by_run(p, s, nullptr, {});
    EXPECT_EQ(slow.failure, "");
    EXPECT_EQ(fast.over_the_top, slow.over_the_top);
    const std::size_t count = std::min(fast.samples.size(), slow.samples.size());
    for (std::size_t i = 0; i < count; ++i) {
        const double off = difference(fast.samples[i], slow.samples[i], p.contact.restitution);
        EXPECT_LT(off, kSame) << "sample " << i << " at t = " << slow.samples[i][kSampleTime];
        if (!(off < kGrown)) return static_cast<int>(i);
    }
    EXPECT_TRUE(fast.over_the_top || fast.samples.size() == slow.samples.size());
    return static_cast<int>(count);
}

TEST(RigidMotion, HasTheImpactsOfTheGeneralRun) {
    int compared = 0;
    for (const double speed : {0.0, 1.0, 5.0, -5.0, 20.0, 48.0})
        for (const double restitution : {0.0, 0.3, 0.7, 1.0}) {
            SCOPED_TRACE(::testing::Message() << speed << " " << restitution);
            const Problem p = rigid_newton(speed, 0.02, restitution);
            compared += expect_same(p, first_turns(std::max(1.0, std::ceil(std::fabs(speed) * 1.0 / 6.28))));
        }
    EXPECT_GT(compared, 150);
}

TEST(RigidMotion, HasTheImpactsOfTheGeneralRunWithTorqueHubRadiusAndOffset) {
    int compared = 0;
    for (const double torque : {-1.5, -0.4, 0.0})
        for (const double radius : {-0.05, 0.0, 0.1}) {
            SCOPED_TRACE(::testing::Message() << torque << " " << radius);
            Problem p = rigid_newton(30, 0.005, 0.5);
            p.hub = {radius, 0.01, ConstantTorque{torque}};
            p.contact.offset.reset();
            p.cam->centre = {0.45, 0.03};
            p.cam->phase = 1;
            p.gravity = torque < -1 ? 0 : 9.81;
            compared += expect_same(p, first_turns(5));
        }
    EXPECT_GT(compared, 50);
}

TEST(RigidMotion, HasTheImpactsOfTheGeneralRunFromBelow) {
    Problem p = rigid_newton(30, 0.005, 0.5);
    p.hub.drive = ConstantTorque{4};
    p.hub.inertia = 0.02;
    p.initial.angle = -0.9;
    EXPECT_GT(expect_same(p, first_turns(8)), 5);
}

// Random cams, torques, gravities, offsets, hubs and starts.
Problem random_motion(Dice& dice) {
    Problem p = rigid_newton(0, 0, dice.one_of(6) ? dice.between(0.05, 1) : 1);
    p.cam->centre = {dice.between(0.2, 0.8), dice.about_zero(0.2)};
    p.cam->radius = dice.between(0.01, 0.15);
    p.cam->eccentricity = dice.one_of(10) ? p.cam->radius * std::pow(10, dice.between(-3, -0.3)) : 0;
    p.cam->phase = dice.about_zero(7);
    p.cam->speed = (dice.one_of(2) ? 1 : -1) * (dice.one_of(12) ? std::pow(10, dice.between(-0.5, 2.3)) : 0);
    p.contact.law = dice.one_of(names(ImpactLaw{}));
    p.hub.radius = dice.one_of(2) ? 0 : dice.between(-0.1, 0.2);
    p.hub.inertia = dice.one_of(2) ? 0 : dice.between(0, 0.1);
    p.gravity = dice.one_of(4) ? dice.between(-2, 20) : 0;
    if (dice.one_of(2)) p.hub.drive = ConstantTorque{dice.between(-30, 10) * p.beam.line_density() / 3};
    if (dice.one_of(3) == 0) p.contact.offset.reset();
    p.initial.angle = dice.between(-1, 1.4);
    p.initial.angular_velocity = dice.about_zero(3);
    if (dice.one_of(5) == 0) p.initial.shape = InitialShape::resting;
    p.solver.rtol = 1e-12;
    return p;
}

TEST(RigidMotion, HasTheImpactsOfTheGeneralRunInRandomProblems) {
    SKIP_UNDER_SANITIZERS();
    int compared = 0;
    for (unsigned seed = 0; seed < 400; ++seed) {
        Dice dice(seed);
        const Problem p = random_motion(dice);
        const Sampling s = first_turns(std::max(1.0, std::floor(std::min(2 / cam_period(p), 20.0))));
        const auto fatal = [](const Issue& finding) { return finding.fatal; };
        if (std::ranges::any_of(validate(p), fatal) || !RigidMotion::applies(p, s)) continue;
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        compared += expect_same(p, s);
    }
    EXPECT_GT(compared, 500);
}

// ---- the surface of the cam --------------------------------------------------------------------------------------

// Random discs that pass the axis at a lever between a millimetre and 0.3 m.
Cam near_the_axis(Dice& dice) {
    Cam cam;
    cam.radius = std::pow(10, dice.between(-2, -0.5));
    cam.eccentricity = cam.radius * std::pow(10, dice.between(-2.5, 0));
    const double lever = std::pow(10, dice.between(-2.95, -0.5));
    cam.centre = (cam.eccentricity + std::hypot(cam.radius, lever)) * unit(dice.about_zero(3));
    cam.phase = dice.about_zero(7);
    cam.speed = dice.about_zero(50);
    return cam;
}

TEST(CamSurface, BoundsItsAccelerationAtEveryPlace) {
    constexpr int kPlaces = 100000;
    Dice dice(17);
    for (int repeat = 0; repeat < 60; ++repeat) {
        SCOPED_TRACE(::testing::Message() << "repeat " << repeat);
        const Cam cam = near_the_axis(dice);
        const CamSurface surface(cam, cam.radius, dice.about_zero(20), dice.about_zero(20));
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (int i = 0; i < kPlaces; ++i) {
            const double s = 2 * std::numbers::pi / std::fabs(cam.speed) * i / kPlaces;
            const double acceleration = surface.acceleration(surface.at(s));
            least = std::min(least, acceleration);
            most = std::max(most, acceleration);
        }
        EXPECT_GE(surface.highest_acceleration(), most);
        EXPECT_LE(surface.lowest_acceleration(), least);
        EXPECT_LT(surface.highest_acceleration() - most, 0.01 * (most - least));
        EXPECT_LT(least - surface.lowest_acceleration(), 0.01 * (most - least));
    }
}

// The torque is such that the cam falls away only around the lowest f, for a part of the turn down to 10⁻⁴.
TEST(CamSurface, FindsEveryIntervalInWhichTheCamFallsAway) {
    constexpr int kPlaces = 100000;
    Dice dice(23);
    int places = 0, brief = 0;
    for (int repeat = 0; repeat < 60; ++repeat) {
        SCOPED_TRACE(::testing::Message() << "repeat " << repeat);
        const Cam cam = near_the_axis(dice);
        const double k = dice.about_zero(20), turn = 2 * std::numbers::pi / std::fabs(cam.speed);
        const CamSurface without(cam, cam.radius, k, 0);
        std::vector<double> push;
        for (int i = 0; i < kPlaces; ++i) push.push_back(without.push(without.at(turn * i / kPlaces)));
        const auto [least, most] = std::ranges::minmax(push);
        const double range = most - least, alpha = least + std::pow(10, dice.between(-7, -0.5)) * range;
        const CamSurface surface(cam, cam.radius, k, alpha);
        ASSERT_FALSE(surface.lifts().empty());
        for (int i = 0; i < kPlaces; ++i) {
            const double f = push[static_cast<std::size_t>(i)] - alpha, s = turn * i / kPlaces;
            if (std::fabs(f) < 1e-10 * range) continue;
            const bool falls = std::ranges::any_of(surface.lifts(), [&](const CamSurface::Lift& lift) {
                return (lift.from < s && s < lift.to) || (lift.from < s + turn && s + turn < lift.to);
            });
            EXPECT_EQ(falls, f < 0) << "at " << s / turn << " of the turn, f = " << f;
            if (f < 0) ++places;
        }
        for (const CamSurface::Lift& lift : surface.lifts()) {
            EXPECT_LT(lift.from, lift.to);
            if (lift.to - lift.from < 1e-3 * turn) ++brief;
        }
    }
    EXPECT_GT(places, 1000);
    EXPECT_GT(brief, 5);
}

// There the surface turns so sharply that samples of its acceleration at every half degree miss most of it.
TEST(RigidMotion, HasTheImpactsOfTheGeneralRunWhereTheDiscPassesTheAxisClosely) {
    SKIP_UNDER_SANITIZERS();
    int compared = 0;
    for (unsigned seed = 0; seed < 250; ++seed) {
        Dice dice(seed);
        Problem p = rigid_newton(dice.about_zero(12), 0, dice.between(0.1, 0.9));
        const Cam cam = near_the_axis(dice);
        p.cam->radius = std::min(cam.radius, 0.2);
        p.cam->eccentricity = std::min(cam.eccentricity, 0.15);
        p.cam->centre = (p.cam->eccentricity + std::hypot(p.cam->radius, 1.1e-3 * std::pow(10, dice.between(0, 1)))) *
                        unit(dice.about_zero(1));
        p.cam->phase = cam.phase;
        p.initial.angle = 1.45;
        p.initial.angular_velocity = dice.about_zero(2);
        p.hub.inertia = dice.between(0, 0.1);
        const Sampling s = first_turns(2);
        const auto fatal = [](const Issue& finding) { return finding.fatal; };
        if (std::ranges::any_of(validate(p), fatal) || !RigidMotion::applies(p, s)) continue;
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        compared += expect_same(p, s);
    }
    EXPECT_GT(compared, 100);
}

TEST(RigidMotion, TakesSectionsOfTheGeneralRun) {
    Sampling s = first_turns(8);
    s.kind = SampleKind::section;
    for (const double level : {0.0, 2.0}) {
        s.level = level;
        EXPECT_EQ(expect_same(rigid_newton(30, 0.005, 0.5), s), 8);
    }
}

TEST(RigidMotion, TakesEveryMotionItIsGivenOrLeavesItToTheRun) {
    const Sampling s = first_turns(1);
    Problem p = rigid_newton(30, 0.005, 0.5);
    EXPECT_TRUE(RigidMotion::applies(p, s));
    p.contact.friction = CoulombFriction{};
    EXPECT_FALSE(RigidMotion::applies(p, s));
    p = rigid_newton(30, 0.005, 0.5);
    p.cam->centre = {1.0, 0};  // may touch the tip
    EXPECT_FALSE(RigidMotion::applies(p, s));
    p = rigid_newton(30, 0.005, 0.5);
    p.solver.method = Method::rk8;
    EXPECT_FALSE(RigidMotion::applies(p, s));
    Sampling apexes = s;
    apexes.kind = SampleKind::apexes;
    EXPECT_FALSE(RigidMotion::applies(rigid_newton(30, 0.005, 0.5), apexes));
}

// ---- closed forms -----------------------------------------------------------------------------------------------

// Gravity 0, hub torque −αJ: e = 2 mm, r = 0.5, α = 15 rad/s², D = 0.25 m, R = 0.1 m.
Problem torque_case(double speed) {
    Problem p = rigid_newton(speed, 0.002, 0.5);
    p.gravity = 0;
    p.initial.angle = 0.42;
    const double inertia = p.beam.line_density() / 3;
    p.hub.drive = ConstantTorque{-15 * inertia};
    return p;
}

// It starts on the orbit with one impact a turn under a steady pull α: θ̇_c = (αT/2)(1 − r)/(1 + r) at the impact,
// where θ̈_c < 0.
Problem on_its_orbit(Problem p, double alpha) {
    const double speed = p.cam->speed, half = 0.5 * alpha * cam_period(p), impact = half * 0.5 / 1.5;
    const CamSurface surface(*p.cam, p.cam->radius, 0, -alpha);
    const auto rate = [&](double s) { return surface.rate(surface.at(s)) - impact; };
    const double turn = cam_period(p);
    for (int i = 0; i < 2000; ++i) {
        const double from = turn * i / 2000, to = turn * (i + 1) / 2000;
        if (!(rate(from) > 0 && rate(to) <= 0)) continue;
        const double s = find_root(rate, from, to);
        p.cam->phase -= speed * s;
        p.initial.angle = surface.at(s).angle + 1e-9;
        p.initial.angular_velocity = half;
        return p;
    }
    throw std::logic_error("no such orbit");
}

Attractor attractor_at(double speed, double turns, bool exponents = false) {
    Sampling s;
    s.transient.turns = turns;
    s.keep.turns = 60;
    s.exponents = exponents;
    return sweep_point(on_its_orbit(torque_case(speed), 15), s, nullptr, {}).attractor;
}

TEST(RigidMotion, HasTheFoldAndTheDoublingOfTheTorqueCaseWhereTheyMustBe) {
    // Fold at 42.23567502238, period doubling at 50.86884987331 rad/s.
    for (const double speed : {42.24, 45.0, 50.84}) {
        const Attractor a = attractor_at(speed, 5000);
        EXPECT_EQ(a.kind, AttractorClass::periodic) << speed;
        EXPECT_EQ(a.period, 1) << speed;
        EXPECT_EQ(a.impacts_per_period, 1) << speed;
    }
    EXPECT_THROW(attractor_at(42.23, 10), std::logic_error);
    const Attractor doubled = attractor_at(50.90, 5000);
    EXPECT_EQ(doubled.kind, AttractorClass::periodic);
    EXPECT_EQ(doubled.period, 2);
    EXPECT_EQ(doubled.impacts_per_period, 2);
}

TEST(RigidMotion, FollowsADifferenceAsTheMultipliersDemand) {
    // One impact a turn: μ₁μ₂ = r². At the doubling μ₁ = −1, so the largest exponent vanishes; in the middle of the
    // window the multipliers are complex, |μ| = r.
    const Attractor doubling = attractor_at(50.8688, 20000, true), middle = attractor_at(46.5, 2000, true);
    EXPECT_NEAR(doubling.exponent, 0, 1e-3);
    EXPECT_NEAR(middle.exponent, std::log(0.5) / cam_period(torque_case(46.5)), 0.2);
}

// A small cam far from the hub is a vibrating table: amplitude e, acceleration a = kℓ cos θ; Γ = eω²/a.
Attractor bouncing_ball(double gamma) {
    Problem p = rigid_newton(0, 1e-6, 0.5);
    p.cam->centre = {0.25, -0.0};
    p.cam->radius = 1e-3;
    const double lever = std::sqrt(0.25 * 0.25 - 1e-6), fall = 1.5 * 9.81 * std::cos(std::asin(1e-3 / 0.25));
    p.cam->speed = std::sqrt(gamma * fall * lever / p.cam->eccentricity);
    Sampling s;
    s.transient.turns = 3000;
    s.keep.turns = 60;
    return sweep_point(on_its_orbit(p, fall), s, nullptr, {}).attractor;
}

TEST(RigidMotion, IsABouncingBallWhereTheCamIsSmall) {
    // r = 0.5, one turn a flight: fold at 1.0471975512, period doubling at 1.5268237005.
    EXPECT_THROW(bouncing_ball(1.0465), std::logic_error);
    for (const double gamma : {1.0480, 1.3, 1.5255}) {
        const Attractor a = bouncing_ball(gamma);
        EXPECT_EQ(a.kind, AttractorClass::periodic) << gamma;
        EXPECT_EQ(a.period, 1) << gamma;
        EXPECT_EQ(a.impacts_per_period, 1) << gamma;
    }
    const Attractor doubled = bouncing_ball(1.5285);
    EXPECT_EQ(doubled.kind, AttractorClass::periodic);
    EXPECT_EQ(doubled.period, 2);
}

TEST(RigidMotion, RestsOnACamThatStandsStill) {
    Sampling s;
    const SweepPoint point = sweep_point(rigid_newton(0, 0.02, 0.5), s, nullptr, {});
    EXPECT_EQ(point.attractor.kind, AttractorClass::rest);
    EXPECT_TRUE(point.motion.samples.empty());
}

// A quarter of its impacts is so slow that they alone could make its exponent positive: no method calls it chaotic.
TEST(RigidMotion, IsNotChaoticWhereNearGrazingImpactsMakeItDoubtful) {
    Sampling s;
    s.transient = {500, {}};
    s.keep = {470, {}};
    s.exponents = true;
    Problem p = rigid_newton(49.55, 0.002, 0.5);
    p.initial.angle = 0.5;
    ASSERT_TRUE(RigidMotion::applies(p, s));
    const Attractor a = sweep_point(p, s, nullptr, {}).attractor;
    EXPECT_EQ(a.kind, AttractorClass::aperiodic);
    EXPECT_GT(a.exponent, 3 * a.exponent_error);
}

// scenes/pressed.json at another speed of the cam.
Problem pressed(double speed, double angle) {
    Problem p = rigid_newton(speed, 0.002, 0.5);
    p.gravity = 0;
    p.hub.drive = ConstantTorque{-1.0094};
    p.cam->phase = 0.5;
    p.initial.angle = angle;
    return p;
}
Attractor attractor_of(const Problem& p, double left_out, double kept, bool exponents = false) {
    Sampling s;
    s.transient = {left_out, {}};
    s.keep = {kept, {}};
    s.exponents = exponents;
    return sweep_point(p, s, nullptr, {}).attractor;
}

// It reaches sustained contact every 17 turns.
TEST(RigidMotion, IsPeriodicWhereSustainedContactReturns) {
    const Attractor a = attractor_of(pressed(53.6, 0.46), 500, 60);
    EXPECT_EQ(a.kind, AttractorClass::periodic);
    EXPECT_EQ(a.period, 17);
}

TEST(SweepPoint, IsChaoticOnlyWhereExponentsAreAskedFor) {
    const Attractor unasked = attractor_of(pressed(54.5, 0.5), 500, 200);
    EXPECT_EQ(unasked.kind, AttractorClass::aperiodic);
    EXPECT_TRUE(std::isnan(unasked.exponent));
    const Attractor asked = attractor_of(pressed(54.5, 0.5), 500, 200, true);
    EXPECT_EQ(asked.kind, AttractorClass::chaotic);
    EXPECT_NEAR(asked.exponent, 3.4, 0.5);
}

TEST(RigidMotion, FollowsASlowCam) {
    const SweepPoint point = sweep_point(rigid_newton(5, 0.002, 0.5), Sampling{}, nullptr, {});
    EXPECT_EQ(point.attractor.kind, AttractorClass::following);
}

TEST(RigidMotion, ChatterOnACamAtRestEndsWhenItMust) {
    // At t₁ + 2 r w/(α(1 − r)), with w the first rate at the cam; flights are parabolas.
    Problem p = torque_case(0);
    const double r = 0.5, alpha = 15;
    const SampledMotion motion = RigidMotion(p, first_turns(2), nullptr).follow({});
    ASSERT_GT(motion.samples.size(), 8u);
    const MotionSample &first = motion.samples.front(), &last = motion.samples.back();
    const double w = -first[kThetaDot], ends = first[kSampleTime] + 2 * r * w / (alpha * (1 - r));
    const double lever = std::sqrt(0.252 * 0.252 - 0.01);
    EXPECT_NEAR(last[kSampleTime] + 2 * last[kNormalAfter] / lever / (alpha * (1 - r)), ends, 1e-12);
}

}  // namespace
}  // namespace beamcam::sim::testing
