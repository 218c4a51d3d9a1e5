// Motions on cams with a profile: against the law that the cam was made for, the disc, and the methods against each
// other.
#include <cmath>
#include <numbers>

#include "sim/cam/lever.hpp"
#include "tests/sim/cam/profiles.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

// A rigid lever that begins at rest on the cam of the lift and return law.
Problem follower(ContactModel contact, double speed) {
    Problem p = with_profile(lift_and_return());
    p.beam.model = ModelKind::rigid;
    p.cam->speed = speed;
    p.contact.model = contact;
    p.initial.shape = InitialShape::resting;
    set_tolerance(p, 1e-10);
    return p;
}

// A convex outline with a random Fourier series of h.
PointsProfile random_outline(Dice& dice) {
    const double a = dice.about_zero(0.02), b = dice.about_zero(0.006), c = dice.about_zero(0.0015);
    const double pa = dice.about_zero(3), pb = dice.about_zero(3), pc = dice.about_zero(3);
    return points_of(360, [&](double alpha) {
        const double h = 0.08 + a * std::cos(alpha - pa) + b * std::cos(2 * alpha - pb) + c * std::cos(3 * alpha - pc);
        const double slope =
            -a * std::sin(alpha - pa) - 2 * b * std::sin(2 * alpha - pb) - 3 * c * std::sin(3 * alpha - pc);
        return std::pair(h, slope);
    });
}

TEST(ProfileMotion, ARigidLeverFollowsTheLaw) {
    for (const ContactModel contact : {ContactModel::restitution, ContactModel::compliant})
        for (const Method method : {Method::automatic, Method::rk8}) {
            Problem p = follower(contact, 6.5);
            p.solver.method = method;
            const Lever lever(p);
            std::vector<double> times;
            for (int i = 0; i <= 60; ++i) times.push_back(0.02 * i);
            const auto of = [&](const char* name) { return series(p, name, times); };
            const std::vector<double> theta = of("theta"), gap = of("gap"), x = of("contact_x");
            for (std::size_t i = 0; i < times.size(); ++i)  // the penetration turns the lever
                EXPECT_NEAR(theta[i] - gap[i] / x[i], lever.at(6.5 * times[i]).motion.theta, 2e-9) << times[i];
        }
}

// The lever leaves the cam within a turn beyond the speed of the closed form, and not below it.
TEST(ProfileMotion, ALeverJumpsAtTheSpeedOfTheClosedForm) {
    for (const bool spring : {false, true}) {
        Problem p = follower(ContactModel::restitution, 1);
        if (spring) p.hub.spring = {0.5, -60 * kDegree, 0};
        const auto lifts = [&](double speed) {
            p.cam->speed = speed;
            Request request;
            request.end_time = 2 * std::numbers::pi / speed;
            request.extrema = {channel("gap")};
            return simulate(p, request).extrema.front().max > 1e-9;
        };
        const double jump = spring ? 9.176477235 : 6.900035815;
        EXPECT_FALSE(lifts(jump * (1 - 1e-5))) << spring;
        EXPECT_TRUE(lifts(jump * (1 + 1e-3))) << spring;
    }
}

// A lift below the error of a step is not seen, but the landing after it is.
TEST(ProfileMotion, ALeverThatHardlyJumpsLandsAgain) {
    Problem disc;
    disc.cam->eccentricity = 0.01;
    disc.beam.model = ModelKind::rigid;
    disc.contact.model = ContactModel::restitution;
    Problem law = disc;
    law.cam->profile = LawProfile{14 * kDegree,
                                  {{MotionLaw::harmonic, 6 * kDegree, 90 * kDegree},
                                   {MotionLaw::dwell, 0, 60 * kDegree},
                                   {MotionLaw::harmonic, -6 * kDegree, 120 * kDegree},
                                   {MotionLaw::dwell, 0, {}}}};
    for (Problem* p : {&disc, &law})
        for (const double beyond : {1e-5, 1e-4, 6e-4}) {
            p->initial.shape = InitialShape::resting;
            const auto jump = Lever(*p).jump();
            ASSERT_TRUE(jump);
            p->cam->speed = jump->speed * (1 + beyond);
            EXPECT_GT(extremum(*p, "gap", 4).min, -2e-7) << beyond;
        }
}

// A stiff contact follows the cam in steps much longer than its vibration, which each jump of ρ excites.
TEST(ProfileMotion, AStiffContactFollowsTheCamOverJumpsOfTheCurvature) {
    Problem arcs = with_profile(tangent_arcs());
    arcs.cam->speed = 6;
    arcs.hub.spring = {1, -60 * kDegree, 0.01};
    Problem law = follower(ContactModel::compliant, 4);
    for (LawSegment& segment : std::get<LawProfile>(*law.cam->profile).segments)
        if (segment.law != MotionLaw::dwell) segment.law = MotionLaw::harmonic;
    for (Problem p : {arcs, law})
        for (const double stiffness : {1e9, 1e12}) {
            p.beam.model = ModelKind::rigid;
            p.initial.shape = InitialShape::resting;
            p.contact.stiffness = stiffness;
            set_tolerance(p, 1e-8);
            const double end = 2 * std::numbers::pi / p.cam->speed;
            const auto forces = [&](Method method) {
                p.solver.method = method;
                return extremum(p, "contact_force", end);
            };
            const Extremum own = forces(Method::automatic), other = forces(Method::rk8);
            EXPECT_GT(other.min, 0) << stiffness;
            EXPECT_NEAR(own.min, other.min, 1e-4 * other.max) << stiffness;
            EXPECT_NEAR(own.max, other.max, 1e-4 * other.max) << stiffness;
        }
}

// At the joints of the law θ″ jumps; θ′ is that of the law on both sides.
TEST(ProfileMotion, ARestingLeverStartsWithTheRateOfTheLawAlsoAtJumpsOfTheCurvature) {
    for (const double speed : {-4.0, 4.0})
        for (const double joint : {60.0, 160.0, 200.0, 320.0})
            for (const double after : {-0.01, 0.0, 0.01}) {
                Problem p = follower(ContactModel::restitution, speed);
                for (LawSegment& segment : std::get<LawProfile>(*p.cam->profile).segments)
                    if (segment.law != MotionLaw::dwell) segment.law = MotionLaw::harmonic;
                p.cam->phase = -joint * kDegree - after;
                const double expected = speed * Lever(p).at(-p.cam->phase).motion.velocity;
                EXPECT_NEAR(series(p, "theta_dot", {0})[0], expected, 2e-7) << speed << " " << joint << " " << after;
            }
}

// After thousands of turns the time does not distinguish the instants about a joint at which θ̈ jumps.
TEST(ProfileMotion, SustainedImpulsesPassTheJointsOfArcsAtLateTimes) {
    Problem p;
    p.cam->profile = ArcsProfile{{{{0, 0}, 0.06895561258583952},
                                  {{-0.060922469040389116, 0.1515623130985953}, 0.2323039581108977},
                                  {{0.034084154496279224, 0}, 0.05342580609776099},
                                  {{-0.060922469040389116, -0.1515623130985953}, 0.2323039581108977}}};
    p.beam.model = ModelKind::rigid;
    p.gravity = 0;
    p.hub.drive = ConstantTorque{-2.0623967500964313};
    p.contact.model = ContactModel::restitution;
    p.contact.restitution = 0.3;
    p.cam->phase = 0.3;
    p.initial.shape = InitialShape::resting;
    for (const double speed : {35.1, 41.9, 54.7}) {
        p.cam->speed = speed;
        const Result r = run(p, 600);
        EXPECT_LT(r.energy_residual_max, 1e-6 * r.energy_scale) << speed;
    }
}

// A method of few evaluations sees a short rise after a long dwell.
TEST(ProfileMotion, EveryMethodSeesAShortRise) {
    Problem p = follower(ContactModel::restitution, 1);
    p.cam->profile = LawProfile{16 * kDegree,
                                {{MotionLaw::dwell, 0, 280 * kDegree},
                                 {MotionLaw::polynomial_4567, 0.5 * kDegree, 40 * kDegree},
                                 {MotionLaw::polynomial_4567, -0.5 * kDegree, {}}}};
    set_tolerance(p, 1e-8);
    for (const Method method : {Method::automatic, Method::rk8, Method::cvode_adams, Method::cvode_bdf}) {
        p.solver.method = method;
        EXPECT_NEAR(extremum(p, "theta", 12).max, 16.5 * kDegree, 1e-6) << name(method);
    }
}

TEST(ProfileMotion, ADiscAsArcOrPointsMovesTheBeamAlike) {
    Problem disc;
    disc.beam.modes = 3;
    disc.cam->speed = 7;
    set_tolerance(disc, 1e-10);
    Problem arc = disc, points = disc;
    arc.cam->profile = ArcsProfile{{{{0.02, 0}, 0.1}}};
    points.cam->profile =
        points_of(720, [](double alpha) { return std::pair(0.1 + 0.02 * std::cos(alpha), -0.02 * std::sin(alpha)); });
    const std::vector<double> times{0.1, 0.2, 0.25, 0.3};
    for (const char* name : {"theta", "tip_deflection", "gap"}) {
        const std::vector<double> of_disc = series(disc, name, times), of_arc = series(arc, name, times),
                                  of_points = series(points, name, times);
        for (std::size_t i = 0; i < times.size(); ++i) {
            EXPECT_NEAR(of_arc[i], of_disc[i], 1e-9) << name;
            EXPECT_NEAR(of_points[i], of_disc[i], 1e-6) << name;
        }
    }
}

// Impacts on random outlines, by three methods that share only the equations of motion.
TEST(ProfileMotion, MethodsAgreeOnTheImpacts) {
    Dice dice(5);
    for (int repeat = 0; repeat < 12; ++repeat) {
        Problem p = with_profile(random_outline(dice));
        if (repeat % 4 == 3) p.cam->profile = tangent_arcs();
        constexpr ModelKind kModels[] = {ModelKind::rigid, ModelKind::first_order, ModelKind::exact};
        p.beam.model = kModels[repeat % 3];
        p.beam.modes = 2;
        p.cam->centre = {dice.between(0.3, 0.6), 0};
        p.cam->speed = dice.about_zero(12);
        p.cam->phase = dice.about_zero(3);
        p.contact.model = dice.one_of(2) ? ContactModel::compliant : ContactModel::restitution;
        if (dice.one_of(2)) p.hub.spring = {dice.between(0, 3), -0.5, dice.between(0, 0.1)};
        set_tolerance(p, 1e-10);
        ASSERT_TRUE(is_plain(p)) << repeat;
        const Result own = run(p, 0.5);
        for (const Method method : {Method::rk8, Method::cvode_adams}) {
            p.solver.method = method;
            const Result other = run(p, 0.5);
            const std::size_t count = std::min<std::size_t>(3, own.impacts.size());
            ASSERT_GE(other.impacts.size(), count) << repeat;
            for (std::size_t i = 0; i < count; ++i) {
                EXPECT_NEAR(other.impacts[i].t_start, own.impacts[i].t_start, 1e-6) << repeat << name(method);
                EXPECT_NEAR(other.impacts[i].x, own.impacts[i].x, 1e-5) << repeat << name(method);
            }
        }
        EXPECT_LT(own.energy_residual_max, 1e-7) << repeat;
    }
}

}  // namespace
}  // namespace beamcam::sim::testing
