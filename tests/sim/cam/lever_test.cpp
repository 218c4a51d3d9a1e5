#include "sim/cam/lever.hpp"

#include "sim/cam/check_profile.hpp"
#include "tests/sim/cam/profiles.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

Problem lift_and_return_lever() {
    Problem p = with_profile(lift_and_return());
    p.beam.model = ModelKind::rigid;
    return p;
}

TEST(Lever, FollowsTheLawOfItsProfile) {
    for (const double offset : {0.0, 0.01}) {
        Problem p = lift_and_return_lever();
        p.cam->centre = {0.24, -0.03};
        p.contact.offset = offset;
        auto& law = std::get<LawProfile>(*p.cam->profile);
        law.segments[1].law = MotionLaw::modified_sine;
        law.lowest = 10 * kDegree;
        const Lever lever(p);
        const ProgrammedMotion motion(law);
        for (double phi = -3; phi < 9; phi += 0.0173) {
            const Lever::State s = lever.at(phi);
            const LeverMotion m = motion.at(phi);
            EXPECT_NEAR(s.motion.theta, m.theta, 3e-14);  // θ′ times the rounding of α = 9
            EXPECT_NEAR(s.motion.velocity, m.velocity, 1e-13);
            EXPECT_NEAR(s.motion.acceleration, m.acceleration, 1e-12);
            EXPECT_NEAR(s.motion.jerk, m.jerk, 1e-8);
            const Vec2 u = unit(m.theta), c = p.cam->centre;
            EXPECT_NEAR(s.foot, dot(c, u) / (1 + m.velocity), 1e-13);
            // The point of the outline, turned by ψ = −φ about C, lies on the face of the lever.
            const double ahead = s.alpha - phi;
            const Vec2 contact = c + s.point.h * unit(ahead) + s.point.slope * perp(unit(ahead));
            EXPECT_NEAR(norm(contact - (s.foot * u - offset * perp(u))), 0, 1e-13);
        }
    }
}

// The mirror image in the vertical line through the pivot: the beam lies on the left of it, the cam turns the other
// way.
Problem on_the_left(Problem p) {
    p.cam->centre.x = -p.cam->centre.x;
    p.cam->speed = -p.cam->speed;
    p.cam->phase = -p.cam->phase;
    p.initial.angle = std::numbers::pi - p.initial.angle;
    if (auto& spring = p.hub.spring) spring->free_angle = std::numbers::pi - spring->free_angle;
    auto& law = std::get<LawProfile>(*p.cam->profile);
    law.lowest = std::numbers::pi - law.lowest;
    law.segments.back().over = 40 * kDegree;
    std::ranges::reverse(law.segments);
    return p;
}

// The mirror image in the line through the pivot and the axis of the cam: the beam lies below the cam and is pressed
// upwards.
Problem below_the_cam(Problem p) {
    p.gravity = -p.gravity;
    p.cam->speed = -p.cam->speed;
    p.cam->phase = -p.cam->phase;
    p.initial.angle = -p.initial.angle;
    if (auto& spring = p.hub.spring) spring->free_angle = -spring->free_angle;
    auto& law = std::get<LawProfile>(*p.cam->profile);
    law.lowest = -law.lowest;
    law.segments.back().over = 40 * kDegree;
    std::ranges::reverse(law.segments);
    return p;
}

// The mirrored lever rests on the mirrored cam: same speeds, lengths and radii, mirrored angles.
TEST(Lever, MirrorImagesHaveMirroredNumbers) {
    Problem p = lift_and_return_lever();
    p.contact.offset = 0.01;
    p.cam->phase = 0.7;
    p.cam->speed = 5;
    p.hub.spring = HubSpring{0.5, -60 * kDegree, 0.02};
    for (const InitialShape shape : {InitialShape::straight, InitialShape::resting}) {
        p.initial.shape = shape;
        const Lever lever(p);
        const Lever::Summary own = lever.summary();
        const std::vector<double> times{0, 0.1, 0.5, 0.9};
        const std::vector<double> follow = series(p, "theta_follow", times), error = series(p, "lift_error", times);
        for (const bool left : {true, false}) {
            const Problem image = left ? on_the_left(p) : below_the_cam(p);
            const auto mirrored = [&](double theta) { return (left ? std::numbers::pi : 0) - theta; };
            ASSERT_TRUE(check_profile(image).empty());
            const Lever other(image);
            EXPECT_EQ(other.side(), -1);
            for (double phi = 0; phi < kFullTurn; phi += 0.11) {
                const Lever::State a = lever.at(phi), b = other.at(-phi);
                EXPECT_NEAR(b.motion.theta, mirrored(a.motion.theta), 2e-15);
                EXPECT_NEAR(b.motion.velocity, a.motion.velocity, 1e-14);
                EXPECT_NEAR(b.motion.acceleration, -a.motion.acceleration, 1e-13);
                EXPECT_NEAR(b.motion.jerk, a.motion.jerk, 1e-9);
                EXPECT_NEAR(b.foot, a.foot, 1e-15);
                EXPECT_NEAR(other.pressing_moment(b.motion.theta), lever.pressing_moment(a.motion.theta), 1e-14);
            }
            const Lever::Summary s = other.summary();
            EXPECT_NEAR(s.base_radius, own.base_radius, 1e-16);
            EXPECT_NEAR(s.rho_min, own.rho_min, 1e-15);
            EXPECT_NEAR(s.pressure_angle_max, own.pressure_angle_max, 1e-14);
            ASSERT_TRUE(s.jump && own.jump);
            EXPECT_NEAR(s.jump->speed, own.jump->speed, 1e-12);
            EXPECT_NEAR(s.jump->phi, kFullTurn - own.jump->phi, 1e-6);
            const std::vector<double> b = series(image, "theta_follow", times), e = series(image, "lift_error", times);
            for (std::size_t i = 0; i < times.size(); ++i) {
                EXPECT_NEAR(b[i], mirrored(follow[i]), 2e-15) << times[i];
                EXPECT_NEAR(e[i], -error[i], 1e-9) << times[i];
            }
        }
    }
}

// A beam that has turned once more has the lever's angle, too.
TEST(Lever, HasTheWholeTurnsOfTheBeam) {
    Problem p = lift_and_return_lever();
    const double follow = Lever(p).at(1).motion.theta;
    p.initial.angle += 2 * kFullTurn;
    EXPECT_NEAR(Lever(p).at(1).motion.theta, follow + 2 * kFullTurn, 1e-14);
}

TEST(Lever, ContactIsWhereTheClosedFormSays) {
    const Lever lever(lift_and_return_lever());
    EXPECT_NEAR(lever.at(0).foot, 0.2425739316, 5e-11);
    EXPECT_NEAR(lever.at(90 * kDegree).foot, 0.2183958995, 5e-11);
    EXPECT_NEAR(lever.at(135 * kDegree).foot, 0.2157085151, 5e-11);
    EXPECT_EQ(lever.pressure_angle(lever.at(1)), 0);
}

// The eccentric disc by its centre: the lever is tangent to a circle of radius R + d about B.
TEST(Lever, FollowsTheDisc) {
    Problem p;
    p.contact.offset = 0.005;
    const Lever lever(p);
    const auto angle = [&](double phi) {
        const Vec2 centre = p.cam->centre + p.cam->eccentricity * unit(-phi);
        return std::atan2(centre.y, centre.x) + std::asin((p.cam->radius + 0.005) / norm(centre));
    };
    for (double phi = 0; phi < kFullTurn; phi += 0.11) {
        const Lever::State s = lever.at(phi);
        EXPECT_NEAR(s.motion.theta, angle(phi), 1e-14);
        const Vec2 centre = p.cam->centre + p.cam->eccentricity * unit(-phi);
        EXPECT_NEAR(s.foot, dot(centre, unit(angle(phi))), 1e-14);
        EXPECT_NEAR(s.motion.velocity, scalar_slope_at_zero([&](double x) { return angle(phi + x); }, 1e-2), 1e-11);
        const auto velocity = [&](double x) { return lever.at(phi + x).motion.velocity; };
        const auto acceleration = [&](double x) { return lever.at(phi + x).motion.acceleration; };
        EXPECT_NEAR(s.motion.acceleration, scalar_slope_at_zero(velocity, 1e-2), 1e-10);
        EXPECT_NEAR(s.motion.jerk, scalar_slope_at_zero(acceleration, 1e-2), 1e-9);
        EXPECT_NEAR(lever.pressure_angle(s), std::atan(0.005 / s.foot), 1e-15);
    }
}

// About the pivot.
double inertia(const Problem& p) { return make_model(p)->linearize().mass(0, 0); }

TEST(Lever, JumpsAtThePublishedSpeed) {
    const Problem p = lift_and_return_lever();
    const Lever lever(p);
    const auto jump = lever.jump();
    ASSERT_TRUE(jump);
    EXPECT_NEAR(jump->speed, 6.900035815, 5e-10);
    // The force vanishes there and nowhere else.
    const auto force = [&](double phi, double speed) {
        const Lever::State s = lever.at(phi);
        return (inertia(p) * speed * speed * s.motion.acceleration + lever.pressing_moment(s.motion.theta)) / s.foot;
    };
    EXPECT_NEAR(force(jump->phi, jump->speed), 0, 1e-9);
    for (double phi = 0; phi < kFullTurn; phi += 0.003) EXPECT_GT(force(phi, jump->speed), -1e-9);
}

TEST(Lever, SummaryIsThatOfTheLaw) {
    Problem p = lift_and_return_lever();
    const Lever::Summary s = Lever(p).summary();
    EXPECT_NEAR(s.base_radius, 0.25 * std::sin(14 * kDegree), 1e-15);
    EXPECT_NEAR(s.rho_min, 0.03663479779, 5e-12);
    EXPECT_NEAR(s.rho_min_phi, 136.82916 * kDegree, 1e-5);
    EXPECT_NEAR(s.rho_max, 0.11911152977, 5e-12);
    EXPECT_EQ(s.pressure_angle_max, 0);
    EXPECT_NEAR(s.jump->speed, 6.900035815, 5e-10);
    // With an offset the face is pushed where x_c is least.
    p.contact.offset = 0.01;
    const Lever lever(p);
    double least = 1;
    for (double phi = 0; phi < kFullTurn; phi += 1e-4) least = std::min(least, lever.at(phi).foot);
    EXPECT_NEAR(lever.summary().pressure_angle_max, std::atan(0.01 / least), 1e-9);
    EXPECT_NEAR(lever.summary().base_radius, 0.25 * std::sin(14 * kDegree) - 0.01, 1e-15);
}

TEST(Lever, ASpringHoldsItUntilAHigherSpeed) {
    Problem p = lift_and_return_lever();
    p.hub.spring = HubSpring{0.5, -60 * kDegree, 0};
    EXPECT_NEAR(Lever(p).jump()->speed, 9.176477235, 5e-10);
    // With damping, by the force itself: it is positive below the speed, and vanishes at it.
    p.hub.spring->damping = 0.02;
    for (const double sense : {1.0, -1.0}) {
        p.cam->speed = sense;
        const Lever lever(p);
        const auto least = [&](double speed) {
            double force = 1e9;
            for (double phi = 0; phi < kFullTurn; phi += 1e-3) {
                const LeverMotion m = lever.at(phi).motion;
                force = std::min(force, inertia(p) * speed * speed * m.acceleration +
                                            sense * 0.02 * speed * m.velocity + lever.pressing_moment(m.theta));
            }
            return force;
        };
        const double speed = lever.jump()->speed;
        EXPECT_NEAR(least(speed), 0, 1e-6);
        EXPECT_GT(least(0.99 * speed), 1e-3);
    }
}

TEST(Lever, JumpsAtOnceWhereNothingPresses) {
    Problem p = lift_and_return_lever();
    p.hub.drive = ConstantTorque{3};
    const auto lifted = Lever(p).jump();
    ASSERT_TRUE(lifted);
    EXPECT_EQ(lifted->speed, 0);
    p.hub.drive = ConstantTorque{-1};
    EXPECT_GT(Lever(p).jump()->speed, 6.900035815);
    p.hub.drive = HarmonicTorque{1, 1, 0};
    EXPECT_FALSE(Lever(p).jump());
    Problem round;
    round.cam->eccentricity = 0;
    EXPECT_FALSE(Lever(round).jump());
}

// With a jump of θ″ at the start of the return the limit from its side counts.
TEST(Lever, JumpsAtAJumpOfTheAcceleration) {
    Problem p = lift_and_return_lever();
    std::get<LawProfile>(*p.cam->profile).segments[3].law = MotionLaw::harmonic;
    const Lever lever(p);
    const double rise = 8 * kDegree, over = 120 * kDegree, top = 22 * kDegree;
    const double acceleration = -0.5 * std::numbers::pi * std::numbers::pi * rise / (over * over);
    const double expected = std::sqrt(lever.pressing_moment(top) / (-inertia(p) * acceleration));
    const double of_the_rise = 6.900035815;
    ASSERT_TRUE(lever.jump());
    EXPECT_NEAR(lever.jump()->speed, std::min(expected, of_the_rise), 1e-9);
}

// The channel is that of the cam's turn at the instant, also of a disc.
TEST(Lever, ChannelsAreItsAngleAndTheHubsDeviation) {
    Problem law = lift_and_return_lever();
    law.cam->phase = 0.7;
    law.cam->speed = -3;
    for (const Problem& p : {law, Problem{}}) {
        const Lever lever(p);
        const std::vector<double> times{0, 0.1, 0.5, 0.9};
        const std::vector<double> follow = series(p, "theta_follow", times), error = series(p, "lift_error", times),
                                  theta = series(p, "theta", times);
        for (std::size_t i = 0; i < times.size(); ++i) {
            const double phi = -(p.cam->phase - p.cam->speed * times[i]);
            EXPECT_NEAR(follow[i], lever.at(phi).motion.theta, 1e-15);
            EXPECT_NEAR(error[i], theta[i] - follow[i], 1e-15);
        }
    }
}

TEST(Lever, OneArcAndManyPointsAreTheDisc) {
    const Lever disc{Problem{}};
    const Lever arc(with_profile(ArcsProfile{{{{0.02, 0}, 0.1}}}));
    const Lever points(with_profile(
        points_of(720, [](double alpha) { return std::pair(0.1 + 0.02 * std::cos(alpha), -0.02 * std::sin(alpha)); })));
    ASSERT_TRUE(disc.jump() && arc.jump() && points.jump());
    EXPECT_NEAR(arc.jump()->speed, disc.jump()->speed, 1e-12);
    EXPECT_NEAR(points.jump()->speed, disc.jump()->speed, 1e-4);
    for (double phi = 0; phi < kFullTurn; phi += 0.21) {
        EXPECT_NEAR(arc.at(phi).motion.theta, disc.at(phi).motion.theta, 1e-14);
        EXPECT_NEAR(points.at(phi).motion.theta, disc.at(phi).motion.theta, 1e-11);
    }
}

}  // namespace
}  // namespace beamcam::sim::testing
