#include "render/plot/placement.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "render/film/film.hpp"
#include "tests/render/synthetic.hpp"
#include "tests/sanitizers.hpp"

namespace beamcam::render {
namespace {

TEST(Placement, CoversTheCellsThatAShapeTouchesAndNoOthers) {
    OccupancyGrid room({100, 200, 80, 60}, 4);
    EXPECT_EQ(room.covered({100, 200, 80, 60}), 0);
    room.cover_convex(std::array{Vec2{110, 210}, Vec2{130, 210}, Vec2{130, 230}, Vec2{110, 230}});
    EXPECT_EQ(room.covered({112, 212, 10, 10}), 1);
    EXPECT_EQ(room.covered({136, 236, 20, 10}), 0);
    room.cover_disc(Vec2{160, 240}, 10);
    EXPECT_EQ(room.covered({158, 238, 3, 3}), 1);
    EXPECT_EQ(room.covered({144, 224, 3, 3}), 0);     // the corner of the circle's box
    EXPECT_GT(room.covered({90, 200, 20, 10}), 0.4);  // half of it lies beyond
}

TEST(Placement, CoveredBoxesAreTheRunsOfEachRow) {
    OccupancyGrid room({10, 20, 50, 20}, 10);
    room.cover(Box{11, 21, 15, 5}, 1);
    room.cover(Box{45, 22, 2, 2}, 1);
    room.cover(Box{12, 32, 2, 2}, 0.1);
    const std::vector<Box> expected{{10, 20, 20, 10}, {40, 20, 10, 10}};
    EXPECT_EQ(room.covered_boxes(), expected);
}

TEST(Placement, ATriangleCoversNoMoreThanItsCells) {
    OccupancyGrid room({0, 0, 100, 100}, 2);
    room.cover_convex(std::array{Vec2{0, 0}, Vec2{100, 0}, Vec2{0, 100}});
    EXPECT_EQ(room.covered({10, 10, 30, 30}), 1);
    EXPECT_EQ(room.covered({60, 60, 30, 30}), 0);
    EXPECT_NEAR(room.covered({0, 0, 99, 99}), 0.5, 0.03);
}

TEST(Placement, TheFirstFreePlaceIsChosenElseTheLeastCovered) {
    OccupancyGrid room({0, 0, 100, 100}, 2);
    const std::vector<Box> places = places_along({0, 0, 100, 100}, {20, 10}, Corner::top_left);
    EXPECT_EQ(room.choose(places), (Box{0, 0, 20, 10}));
    room.cover(Box{0, 0, 30, 30}, 1);
    EXPECT_EQ(room.choose(places), (Box{80, 0, 20, 10}));
    room.cover(Box{0, 0, 100, 100}, 1);
    EXPECT_EQ(room.choose(places), places.front());
    for (const Box& place : places) EXPECT_TRUE((Box{0, 0, 100, 100}.contains(place)));
}

TEST(Placement, ABoxGoesWhereNothingIs) {
    OccupancyGrid taken({0, 0, 100, 100}, 1.5);
    taken.cover(Box{50, 0, 50, 50});
    taken.cover(std::vector<Vec2>{{0, 90}, {100, 90}});
    const Place place = best_place(taken, 30, 20, 2);
    EXPECT_EQ(place.cost, 0);
    EXPECT_FALSE(place.box.overlaps({50, 0, 50, 50}));
}

// Distance of a segment from a box; 0: they touch.
double distance(Vec2 a, Vec2 b, const Box& box) {
    double least = INFINITY;
    for (int i = 0; i <= 200; ++i) {
        const Vec2 p = a + (b - a) * (i / 200.0);
        const double dx = std::max({box.x - p.x, 0.0, p.x - box.right()}),
                     dy = std::max({box.y - p.y, 0.0, p.y - box.bottom()});
        least = std::min(least, std::hypot(dx, dy));
    }
    return least;
}

// How near the first mechanism comes to its label and its scale bar [px].
double nearest_to_words(FilmSetup setup, std::size_t words) {
    setup.view.style = Style::flat;
    const double radius = setup.problem.cam->radius + setup.problem.cam->eccentricity;
    const Vec2 axis = setup.problem.cam->centre;
    Film film(std::move(setup));
    double least = INFINITY;
    for (int k = 0; k < film.frames(); ++k) {
        const FrameGeometry g = film.geometry(k);
        EXPECT_EQ(g.legend.size(), words);
        for (const Box& box : g.legend) {
            for (std::size_t i = 0; i + 1 < g.beam.line.size(); i += 4) {
                least = std::min(
                    least, distance(g.camera.to_pixels(g.beam.face(i)), g.camera.to_pixels(g.beam.face(i + 1)), box));
                least = std::min(
                    least, distance(g.camera.to_pixels(g.beam.back(i)), g.camera.to_pixels(g.beam.back(i + 1)), box));
            }
            const Vec2 c = g.camera.to_pixels(axis);
            least = std::min(least, distance(c, c, box) - radius * g.camera.scale);
        }
    }
    return least;
}

TEST(Placement, NoBeamEverComesToTheWordsOfAFilm) {
    SKIP_UNDER_SANITIZERS();
    for (const auto& [w, h] : {std::pair{1920, 1080}, {1280, 720}, {1080, 1080}, {640, 640}}) {
        FilmSetup setup = test::synthetic_film({.duration = 0.6});
        setup.width = w, setup.height = h;
        FilmSetup two = setup;
        two.label = "a flexible beam";
        two.others.push_back(setup);
        two.others.back().label = "another";
        EXPECT_GT(nearest_to_words(setup, 1), 0) << w << "x" << h;
        EXPECT_GT(nearest_to_words(two, 2), 0) << w << "x" << h;
    }
}

// A beam that stands upright in the corner where the label would be.
TEST(Placement, WordsGiveWay) {
    FilmSetup setup = test::synthetic_film({.duration = 0.5});
    for (sim::Pose& pose : setup.poses) {
        for (std::size_t i = 0; i < pose.centreline.size(); ++i)
            pose.centreline[i] = {-0.3 * double(i) / 96, double(i) / 96};
        pose.theta = std::atan2(1, -0.3);
        pose.nearest.reset();
    }
    setup.others.push_back(setup);
    setup.label = "one", setup.others[0].label = "two";
    EXPECT_GT(nearest_to_words(setup, 2), 0);
}

}  // namespace
}  // namespace beamcam::render
