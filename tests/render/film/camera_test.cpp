// The moving camera against closed forms; parts outside its view are not drawn.
#include "render/film/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/render/drawing.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

const Camera kWhole{100, {300, 200}};
const Box kBox{0, 0, 640, 480};

std::vector<CameraFrame> seen(const Shot& first, const std::vector<CameraMove>& moves,
                              const std::vector<Followed>& followed, double fps = 60) {
    return camera_frames(first, moves, kWhole, kBox, followed, fps);
}

TEST(Camera, WithoutMovesItIsTheOneThatShowsAll) {
    const CameraFrame all = seen({}, {}, {{}}).front();
    EXPECT_EQ(all.camera.scale, kWhole.scale);
    EXPECT_EQ(all.camera.origin, kWhole.origin);
}

TEST(Camera, WhatItFollowsStandsInTheMiddle) {
    const std::vector<Followed> one{{{0.4, 0.3}, {0.2, 0.1}, {0.25, 0}}};
    for (const auto& [kind, at] : {std::pair{Anchor::Kind::tip, Vec2{0.38, 0.285}},  // a part of the beam behind it
                                   {Anchor::Kind::contact, Vec2{0.2, 0.1}},
                                   {Anchor::Kind::cam, Vec2{0.25, 0}},
                                   {Anchor::Kind::hub, Vec2{0, 0}},
                                   {Anchor::Kind::place, Vec2{-1, 2}}}) {
        const CameraFrame s = seen({.zoom = 5, .follow = {kind, {-1, 2}}}, {}, one).front();
        EXPECT_EQ(s.camera.scale, 500);
        EXPECT_NEAR(norm(s.camera.to_pixels(at) - kBox.centre()), 0, 1e-9);
    }
}

// A symmetric mean preserves uniform motion and removes vibration with periods below a third of a second.
TEST(Camera, FollowsTheMeanOfWhatVibrates) {
    std::vector<Followed> all;
    for (int k = 0; k < 120; ++k) all.push_back({{0.01 * k, k % 2 == 0 ? 0.1 : -0.1}, {}, {}});
    const std::vector<CameraFrame> path = seen({.zoom = 2, .follow = {Anchor::Kind::tip, {}}}, {}, all);
    for (std::size_t k = 20; k < 100; ++k) {
        const Vec2 middle = path[k].camera.to_world(kBox.centre());
        EXPECT_NEAR(middle.x, 0.00875 * static_cast<double>(k), 1e-9);
        EXPECT_NEAR(middle.y, 0, 2e-3);
    }
}

TEST(Camera, MovesArriveWhenTheyAreToAndKeepTheirFixedPoint) {
    const std::vector<Followed> still(61);
    const Shot near{.zoom = 4, .follow = {Anchor::Kind::place, {1, 0.5}}};
    const std::vector<CameraFrame> path =
        seen({}, {{.arrives = 50, .lasts = 40, .ease = Ease::linear, .shot = near}}, still);
    EXPECT_EQ(path[10].zoom, 1);
    EXPECT_NEAR(path[30].zoom, 2, 1e-12);  // the geometric mean, half way
    EXPECT_EQ(path[50].zoom, 4);
    EXPECT_EQ(path[60].zoom, 4);
    EXPECT_NEAR(norm(path[50].camera.to_pixels({1, 0.5}) - kBox.centre()), 0, 1e-9);
    // The point that both views show at the same pixel stays there: p = c1 + s (c2 − c1) with s = z2/(z2 − z1).
    const Vec2 c1 = kWhole.to_world(kBox.centre()), c2{1, 0.5}, fixed = c1 + (c2 - c1) * (4.0 / 3);
    const Vec2 px = kWhole.to_pixels(fixed);
    for (int k = 0; k <= 60; ++k) EXPECT_NEAR(norm(path[std::size_t(k)].camera.to_pixels(fixed) - px), 0, 1e-6) << k;
}

TEST(Camera, EasesAreMonotoneAndACutIsOne) {
    const std::vector<Followed> still(21);
    for (const Ease ease : {Ease::smooth, Ease::linear, Ease::in, Ease::out}) {
        const auto path = seen({}, {{.arrives = 20, .lasts = 20, .ease = ease, .shot = {.zoom = 9}}}, still);
        for (std::size_t k = 1; k < path.size(); ++k) EXPECT_GT(path[k].zoom, path[k - 1].zoom);
    }
    const auto cut = seen({}, {{.arrives = 10, .lasts = 0, .shot = {.zoom = 9}}}, still);
    EXPECT_EQ(cut[9].zoom, 1);
    EXPECT_EQ(cut[10].zoom, 9);
}

FilmSetup film_of(Style style) {
    FilmSetup setup = test::synthetic_film({.duration = 0.5});
    setup.width = 640, setup.height = 360;
    setup.view.style = style;
    return setup;
}

// Drawing does not extend beyond the mechanism's panel. A near camera has an overview in the automatic layout.
void keeps_to_its_panel(Style style) {
    FilmSetup near = film_of(style), nearer = near;
    near.view.shot = {.zoom = 2, .follow = {Anchor::Kind::contact, {}}};
    nearer.view.shot = {.zoom = 6, .follow = {Anchor::Kind::contact, {}}};
    Film whole(near), film(nearer);
    EXPECT_FALSE(Film(film_of(style)).geometry(12).layout.first(PanelKind::overview));
    EXPECT_TRUE(film.geometry(12).layout.first(PanelKind::overview));
    const Box box = film.geometry(12).layout.first(PanelKind::mechanism)->box;
    const Image a = drawn(whole, 12), b = drawn(film, 12);
    const long inside = differing_pixels(a, b, box);
    EXPECT_GT(inside, 10'000);
    EXPECT_EQ(differing_pixels(a, b, {0, 0, double(a.width), double(a.height)}), inside);
    Film fresh = film.for_thread();
    EXPECT_EQ(drawn(fresh, 12), b);
}
TEST(Camera, KeepsToItsPanel) { keeps_to_its_panel(Style::flat); }
TEST(LitCamera, CameraKeepsToItsPanel) {
    SKIP_WITHOUT_GL();
    keeps_to_its_panel(Style::lit);
}
TEST(SolidFilm, CameraKeepsToItsPanel) {
    SKIP_WITHOUT_GL();
    keeps_to_its_panel(Style::solid);
}

TEST(SolidFilm, TheMountDoesNotSlideByItself) {
    SKIP_WITHOUT_GL();
    FilmSetup setup = film_of(Style::solid);
    for (sim::Pose& pose : setup.poses) pose = setup.poses.front();
    Film film(setup);
    EXPECT_EQ(drawn(film, 3), drawn(film, 20));
    EXPECT_TRUE(film.repeats(20));
}

// Films of a cam that turns the other way differ by the heads of the arrow, which no body hides.
TEST(SolidFilm, TheArrowOfTheSpeedIsSeenFromBelow) {
    SKIP_WITHOUT_GL();
    for (const double yaw : {-1.1, 0.42, 1.0, 1.1})
        for (const double pitch : {-0.8, -0.25}) {
            FilmSetup setup = film_of(Style::solid);
            setup.width = 1280, setup.height = 720;
            setup.layout = LayoutNode{};
            setup.view.show = Show::paper;
            setup.view.shot.yaw = yaw, setup.view.shot.pitch = pitch;
            Film film(setup);
            setup.problem.cam->speed *= -1;
            Film other(setup);
            const FrameGeometry g = film.geometry(0);
            EXPECT_GT(differing_pixels(drawn(film, 0), drawn(other, 0), g.layout.panels.front().box), 50)
                << yaw << ", " << pitch;
        }
}

// From any side all bodies are inside the panel.
TEST(SolidFilm, ShowsEverythingFromAllSides) {
    SKIP_WITHOUT_GL();
    for (const double yaw : {-1.1, 0.42, 1.1})
        for (const double pitch : {-0.8, 0.2, 0.9}) {
            FilmSetup setup = film_of(Style::solid);
            setup.width = 640, setup.height = 360;
            setup.layout = LayoutNode{};
            setup.view.show = Show::clean;
            setup.view.transparent = true;
            setup.view.shot.yaw = yaw, setup.view.shot.pitch = pitch;
            Film film(setup);
            const Box box = film.geometry(0).layout.panels.front().box.inset(1);
            for (const int frame : {0, 20}) {
                const Image image = drawn(film, frame);
                long inside = 0, edge = 0;
                for (int y = 0; y < image.height; ++y)
                    for (int x = 0; x < image.width; ++x) {
                        if (image.pixels[static_cast<std::size_t>(y * image.width + x)] >> 24 != 255) continue;
                        ++inside;
                        if (!box.contains({double(x), double(y), 1, 1})) ++edge;
                    }
                EXPECT_GT(inside, 1000) << yaw << ", " << pitch;
                EXPECT_EQ(edge, 0) << yaw << ", " << pitch << ", frame " << frame;
            }
        }
}

TEST(Camera, AFilmWhoseCameraMovesDoesNotStandStill) {
    FilmSetup setup = film_of(Style::flat);
    for (sim::Pose& pose : setup.poses) pose = setup.poses.front();
    setup.moves = {{.arrives = 20, .lasts = 10, .shot = {.zoom = 2}}};
    const Film film(setup);
    EXPECT_TRUE(film.repeats(5));
    EXPECT_FALSE(film.repeats(15));
    EXPECT_TRUE(film.repeats(25));
}

// A near camera cuts shadows at the edges of the panel, where it cuts bodies: they do not fade before those do.
TEST(GlCamera, ShadowsReachTheEdgesOfTheNearPanel) {
    SKIP_WITHOUT_GL();
    FilmSetup setup = film_of(Style::lit);
    setup.view.transparent = true;
    const auto shadows_at_edge = [&](double zoom) {
        setup.view.shot.zoom = zoom;
        Film film(setup);
        const Image image = drawn(film, 0);
        const Layout places = film.geometry(0).layout;
        const Box box = places.first(PanelKind::mechanism)->box.inset(zoom > 2 ? 62 * places.unit : 2);
        int count = 0;
        for (int y = int(box.y); y < int(box.bottom()); ++y)
            for (const int x : {int(box.x), int(box.right())}) {
                const std::uint32_t pixel = pixel_at(image, x, y);
                const std::uint32_t alpha = pixel >> 24;
                count += alpha > 8 && alpha < 40 && (pixel >> 8 & 255) < alpha / 3;  // dark: a shadow alone
            }
        return count;
    };
    EXPECT_LT(shadows_at_edge(1.001), 8);  // the horizontal through O
    EXPECT_GT(shadows_at_edge(4), 20);
}

}  // namespace
}  // namespace beamcam::render
