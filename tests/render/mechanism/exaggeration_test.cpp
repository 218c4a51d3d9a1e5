#include "render/mechanism/exaggeration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/plot/ticks.hpp"
#include "tests/render/synthetic.hpp"
#include "tests/sanitizers.hpp"

namespace beamcam::render {
namespace {

// Distance of the drawn face from the disc, measured on the drawn polygon.
double face_gap(const DrawnBeam& beam, const sim::Pose& pose, double radius) {
    double best = 1e300;
    for (std::size_t i = 0; i + 1 < beam.line.size(); ++i) {
        const Vec2 a = beam.face(i), ab = beam.face(i + 1) - a;
        const double s = std::clamp(dot(pose.disc_centre - a, ab) / dot(ab, ab), 0.0, 1.0);
        best = std::min(best, norm(a + ab * s - pose.disc_centre));
    }
    return best - radius;
}

struct Case {
    double factor;
    bool half_depth;
};
void PrintTo(Case c, std::ostream* out) { *out << c.factor << (c.half_depth ? " half-depth" : " centre line"); }

class Exaggerated : public testing::TestWithParam<Case> {
  protected:
    FilmSetup film = test::synthetic_film({.half_depth = GetParam().half_depth});
    double px = 1.0 / 900;  // [m], of a full-size picture
};

TEST_P(Exaggerated, TouchingBeamStillTouchesWithinHalfAPixel) {
    SKIP_UNDER_SANITIZERS();
    int touching = 0;
    for (const sim::Pose& pose : film.poses) {
        if (!pose.nearest->touching || pose.nearest->gap > 1e-6) continue;
        ++touching;
        const DrawnBeam beam = drawn_beam(film.problem, pose, GetParam().factor, beam_depth(film.problem.beam));
        EXPECT_LT(std::abs(face_gap(beam, pose, film.problem.cam->radius)), 0.5 * px) << "t = " << pose.t;
    }
    EXPECT_GT(touching, 10);
}

TEST_P(Exaggerated, HingeStays) {
    for (const sim::Pose& pose : film.poses) {
        const DrawnBeam beam = drawn_beam(film.problem, pose, GetParam().factor, beam_depth(film.problem.beam));
        EXPECT_LT(norm(beam.line.front()), 1e-15);
    }
}

TEST_P(Exaggerated, BeamEntersTheDiscNowhere) {
    for (const sim::Pose& pose : film.poses) {
        const DrawnBeam beam = drawn_beam(film.problem, pose, GetParam().factor, beam_depth(film.problem.beam));
        EXPECT_TRUE(beam.clear);
        EXPECT_GT(face_gap(beam, pose, film.problem.cam->radius), -0.1 * px) << "t = " << pose.t;
    }
}

INSTANTIATE_TEST_SUITE_P(Factors, Exaggerated,
                         testing::Values(Case{1, false}, Case{2, false}, Case{10, false}, Case{20, false},
                                         Case{40, false}, Case{1, true}, Case{20, true}));

TEST(Exaggeration, FactorOneIsTheTruth) {
    const FilmSetup film = test::synthetic_film();
    const sim::Pose& pose = film.poses[40];
    EXPECT_EQ(drawn_beam(film.problem, pose, 1, beam_depth(film.problem.beam)).line, pose.centreline);
}

TEST(Exaggeration, FilmsOfOneMotionAgreeWhateverTheirFramesAre) {
    FilmSetup all = test::synthetic_film();
    all.survey = all.poses;
    all.width = 640, all.height = 360;
    all.view.style = Style::flat;
    FilmSetup few = all, alone = all;
    few.poses = {all.poses[1], all.poses[3]};
    alone.poses = few.poses;
    alone.survey.clear();
    Film a(std::move(all)), b(std::move(few)), c(std::move(alone));
    EXPECT_EQ(a.exaggeration(), b.exaggeration());
    EXPECT_EQ(a.geometry(1).camera.scale, b.geometry(0).camera.scale);
    EXPECT_EQ(a.geometry(1).camera.to_pixels({0, 0}), b.geometry(0).camera.to_pixels({0, 0}));
    EXPECT_NE(c.exaggeration(), a.exaggeration());
}

// Without a cam the line is (ξ, N η) about the least-squares line; for η orthogonal to rigid rotation that is the
// horizontal, and every station's height is multiplied.
TEST(Exaggeration, FreeVibrationIsMultipliedAboutTheMeanLine) {
    sim::Problem problem;
    problem.cam.reset();
    sim::Pose pose;
    const int n = 101;
    double xy = 0, xx = 0;
    for (int i = 0; i < n; ++i) {
        const double x = i / 100.0;
        xy += x * x * x * 1e-3, xx += x * x;
    }
    for (int i = 0; i < n; ++i) {
        const double x = i / 100.0;
        pose.centreline.push_back({x, 1e-3 * x * x - xy / xx * x});
    }
    const DrawnBeam beam = drawn_beam(problem, pose, 50, beam_depth(problem.beam));
    for (std::size_t i = 0; i < pose.centreline.size(); ++i) {
        EXPECT_NEAR(beam.line[i].y, 50 * pose.centreline[i].y, 1e-12);
        EXPECT_NEAR(beam.line[i].x, pose.centreline[i].x, 1e-12);
    }
}

// The clamp of a prescribed hub does not rotate: w is exaggerated about the hub's direction.
TEST(Exaggeration, DeflectionFromALedHubIsMultipliedAboutItsDirection) {
    sim::Problem problem;
    problem.cam.reset();
    problem.hub.drive = sim::ConstantSpeed{1};
    sim::Pose pose;
    pose.theta = 0.7;
    const Vec2 along = sim::unit(pose.theta), across = sim::perp(along);
    for (int i = 0; i <= 100; ++i) {
        const double x = i / 100.0;
        pose.centreline.push_back(along * x + across * (0.01 * x * x));
    }
    const DrawnBeam beam = drawn_beam(problem, pose, 10, beam_depth(problem.beam));
    EXPECT_NEAR(beam.base_angle, 0.7, 1e-15);
    for (int i = 0; i <= 100; ++i) {
        const double x = i / 100.0;
        EXPECT_LT(norm(beam.line[static_cast<std::size_t>(i)] - (along * x + across * (0.1 * x * x))), 1e-14);
    }
}

// A soft beam that is bent over the disc touches it even if the hub points past the disc.
TEST(Exaggeration, TheSideOfTheCamIsThatOfTheContact) {
    FilmSetup film = test::synthetic_film();
    sim::Pose pose;
    const double radius = film.problem.cam->radius, length = film.problem.beam.length;
    pose.disc_centre = {0.4 * length, 0};
    pose.disc_radius = radius;
    pose.theta = -0.3;
    for (int i = 0; i <= 100; ++i) {
        const double x = length * i / 100;
        pose.centreline.push_back({x, radius - 3 * (x - 0.4 * length) * (x - 0.4 * length) / length});
    }
    pose.nearest = sim::Nearest{};
    pose.nearest->x = 0.4 * length, pose.nearest->normal = {0, 1}, pose.nearest->touching = true;
    EXPECT_EQ(drawn_beam(film.problem, pose, 1, beam_depth(film.problem.beam)).side, 1);
    pose.nearest->normal = {0, -1};
    EXPECT_EQ(drawn_beam(film.problem, pose, 1, beam_depth(film.problem.beam)).side, -1);
}

TEST(Exaggeration, SectionExtendsAwayFromTheCamByItsDepth) {
    FilmSetup film = test::synthetic_film();
    const double h = beam_depth(film.problem.beam);
    const DrawnBeam on_line = drawn_beam(film.problem, film.poses[0], 1, h);
    EXPECT_DOUBLE_EQ(on_line.low, 0);
    EXPECT_DOUBLE_EQ(on_line.high, h);
    film.problem.contact.offset.reset();  // half-depth
    const DrawnBeam centred = drawn_beam(film.problem, film.poses[0], 1, h);
    EXPECT_NEAR(centred.low, -h / 2, 1e-15);
    EXPECT_NEAR(centred.high, h / 2, 1e-15);
}

TEST(Exaggeration, MotionIsContinuousThroughTouchAndRelease) {
    const test::Synthetic how;
    const FilmSetup film = test::synthetic_film(how);
    const double dt = 1e-4;
    Vec2 tip{};
    for (int i = 0; i < 8000; ++i) {
        const sim::Pose pose = test::synthetic_pose(film.problem, how, 0.25 + i * dt);
        const Vec2 now = drawn_beam(film.problem, pose, 20, beam_depth(film.problem.beam)).line.back();
        // True tips move at 3 m/s, exaggerated vibration adds 20·0.08 m/s·…; a jump of a pixel in 0.1 ms would be 10
        // m/s.
        if (i > 0) {
            EXPECT_LT(norm(now - tip) / dt, 10) << pose.t;
        }
        tip = now;
    }
}

static double factor_of(const FilmSetup& film, std::optional<double> requested) {
    return film_factor(
        film.problem, film.poses.size(), [&](std::size_t k) { return film.poses[k]; }, requested);
}

TEST(Exaggeration, FactorOfARigidBeamIsOne) {
    test::Synthetic how;
    how.amplitude = 0;
    const FilmSetup film = test::synthetic_film(how);
    EXPECT_EQ(factor_of(film, {}), 1);
}

TEST(Exaggeration, AutomaticFactorIsRoundAndShowsATenthOfTheLengthAtMost) {
    const FilmSetup film = test::synthetic_film();
    const double n = factor_of(film, {});
    EXPECT_GT(n, 1);
    EXPECT_DOUBLE_EQ(round_down_125(n), n);
    for (const sim::Pose& pose : film.poses) {
        const DrawnBeam beam = drawn_beam(film.problem, pose, n, beam_depth(film.problem.beam));
        const Vec2 base = sim::unit(beam.base_angle);
        for (Vec2 p : beam.line) EXPECT_LE(std::abs(cross(base, p)), 0.1001 * film.problem.beam.length);
    }
}

TEST(Exaggeration, AutomaticFactorOfAStiffBeamIsFifty) {
    test::Synthetic how;
    how.amplitude = 1e-5;
    EXPECT_EQ(factor_of(test::synthetic_film(how), {}), 50);
}

TEST(Exaggeration, AFactorThatWouldEnterTheCamYields) {
    const FilmSetup film = test::synthetic_film();
    const double n = factor_of(film, 5000.0);
    EXPECT_LT(n, 5000);
    for (const sim::Pose& pose : film.poses)
        EXPECT_TRUE(drawn_beam(film.problem, pose, n, beam_depth(film.problem.beam)).clear);
}

// Equal motions are drawn at the same place, even if one of them has no cam.
TEST(Exaggeration, ABeamWithoutACamLiesAsTheOneItIsComparedWith) {
    const FilmSetup with = test::synthetic_film({.duration = 0.1});
    sim::Problem without = with.problem;
    without.cam.reset();
    sim::Pose pose = with.poses.front(), free = pose;
    free.nearest.reset();
    const double depth = beam_depth(with.problem.beam);
    const DrawnBeam a = drawn_beam(with.problem, pose, 1, depth),
                    b = drawn_beam(without, free, 1, depth, &with.problem), alone = drawn_beam(without, free, 1, depth);
    ASSERT_EQ(a.side, 1);
    for (std::size_t i = 0; i < a.line.size(); ++i) {
        EXPECT_NEAR(norm(a.face(i) - b.face(i)), 0, 1e-12);
        EXPECT_NEAR(norm(a.back(i) - b.back(i)), 0, 1e-12);
    }
    EXPECT_NEAR(alone.low, -depth / 2, 1e-15);
}

// A beam that turns over: its section is centred on the hinge while it points away from the cam, moves smoothly to the
// side away from the cam, and is there before the beam can touch.
TEST(Exaggeration, TheSectionOfABeamThatPointsAwayIsCentredOnTheHinge) {
    const FilmSetup film = test::synthetic_film();
    const sim::Problem& problem = film.problem;
    const double h = beam_depth(problem.beam);
    sim::Pose pose = film.poses.front();
    const double last = double(pose.centreline.size() - 1);
    double before = 1;
    for (int degrees = 25; degrees <= 335; ++degrees) {
        pose.theta = degrees * std::numbers::pi / 180;
        const Vec2 along = sim::unit(pose.theta);
        for (std::size_t i = 0; i < pose.centreline.size(); ++i)
            pose.centreline[i] = along * (problem.beam.length * double(i) / last);
        const double x = std::clamp(dot(pose.disc_centre, along), 0.0, problem.beam.length);
        const Vec2 away = along * x - pose.disc_centre;
        pose.nearest->x = x, pose.nearest->normal = away * (1 / norm(away));
        pose.nearest->gap = norm(away) - problem.cam->radius - sim::contact_offset(problem);
        const DrawnBeam beam = drawn_beam(problem, pose, 1, h);
        if (degrees >= 91 && degrees <= 269) {
            EXPECT_NEAR(beam.low, -h / 2, 1e-6 * h) << degrees;
        }
        if (pose.nearest->gap < 0.02) {
            EXPECT_EQ(std::abs(beam.side), 1) << degrees;
        }
        EXPECT_NEAR(beam.side, before, 0.1) << degrees;
        before = beam.side;
    }
    EXPECT_EQ(before, -1);
}

TEST(Exaggeration, ATouchingBeamIsDrawnTouchingWhereItDoes) {
    test::Synthetic how;
    how.amplitude = 6e-3;
    const FilmSetup film = test::synthetic_film(how);
    for (const std::optional<double> wanted : {std::optional<double>(), std::optional(20.0), std::optional(200.0)}) {
        const double n = factor_of(film, wanted);
        int touching = 0;
        for (const sim::Pose& pose : film.poses) {
            const DrawnBeam beam = drawn_beam(film.problem, pose, n, beam_depth(film.problem.beam));
            if (!pose.nearest->touching) continue;
            ++touching;
            EXPECT_NEAR(beam.contact->x, pose.nearest->x, 0.05 * film.problem.beam.length) << n;
        }
        EXPECT_GT(touching, 10);
    }
}

TEST(ExaggeratedCamera, FitsTheWorldAndInvertsItself) {
    Bounds world;
    world.add({-1, -2});
    world.add({3, 1}, 0.5);
    const Box box{10, 20, 300, 200};
    const Camera camera = fit(world, box);
    EXPECT_DOUBLE_EQ(camera.scale, std::min(300 / 4.5, 200 / 3.5));
    const Vec2 middle = camera.to_pixels({1.25, -0.25});
    EXPECT_NEAR(middle.x, 160, 1e-12);
    EXPECT_NEAR(middle.y, 120, 1e-12);
    const Vec2 back = camera.to_world(camera.to_pixels({0.3, 0.7}));
    EXPECT_NEAR(back.x, 0.3, 1e-14);
    EXPECT_NEAR(back.y, 0.7, 1e-14);
    EXPECT_LT(camera.to_pixels({0, 1}).y, camera.to_pixels({0, 0}).y);
}

}  // namespace
}  // namespace beamcam::render
