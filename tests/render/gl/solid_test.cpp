// The bodies of the solid view and the wall that shows their shadows.
#include "render/gl/solid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/gl/lit.hpp"
#include "tests/render/drawing.hpp"

namespace beamcam::render {
namespace {

SolidScene example() {
    MechanismShape shape;
    for (int i = 0; i <= 40; ++i) {
        shape.face.push_back({100.0 + 12 * i, 500.0 - 8 * i});
        shape.back.push_back(shape.face.back() + Vec2{-10, -15});
        shape.colors.push_back({0.5, 0.5, 0.5, 1});
    }
    shape.hinge = {100, 500};
    shape.hub = 20, shape.pin = 6;
    shape.disc = DiscShape{{240, 520}, {235, 515}, 50, 10, 0.3, {270, 510}, 5};
    const Box box{0, 0, 960, 720};
    return solid_scene(shape, palette(Theme::light), box, Perspective::looking(box.centre(), 3000, 1, 0.3, 0.2), 40, 1,
                       {});
}

// Along the light to the wall.
Vec2 shadow(const std::array<float, 3>& place, double wall) {
    const double fall = (double(place[2]) - wall) / kLightNear.z;
    return {double(place[0]) - fall * kLightNear.x, double(place[1]) - fall * kLightNear.y};
}

bool covers(const SolidScene& scene, Vec2 at) {
    for (std::size_t i = 0; i < scene.wall; i += 6) {
        const auto &low = scene.triangles[i].place, &high = scene.triangles[i + 2].place;
        if (at.x >= low[0] && at.x <= high[0] && at.y >= low[1] && at.y <= high[1]) return true;
    }
    return false;
}

TEST(SolidScene, TheWallIsWhereverAShadowFallsAndNotMuchMore) {
    const SolidScene scene = example();
    ASSERT_GT(scene.wall, 0U);
    ASSERT_EQ(scene.wall % 6, 0U);
    const double wall = scene.triangles.front().place[2], blur = 0.0056 * scene.reach;
    for (std::size_t i = scene.wall; i < scene.triangles.size(); ++i) {
        const Vec2 at = shadow(scene.triangles[i].place, wall);
        for (const Vec2 edge : {Vec2{0, 0}, Vec2{blur, 0}, Vec2{-blur, 0}, Vec2{0, blur}, Vec2{0, -blur}})
            ASSERT_TRUE(covers(scene, at + edge)) << at.x << " " << at.y;
        EXPECT_GE(scene.triangles[i].place[2], wall);  // the wall is drawn behind all
    }
    double area = 0;
    for (std::size_t i = 0; i < scene.wall; i += 6) {
        const auto &low = scene.triangles[i].place, &high = scene.triangles[i + 2].place;
        area += double(high[0] - low[0]) * double(high[1] - low[1]);
    }
    EXPECT_LT(area, 0.25 * 960 * 720);
}

// Triangles that face away are drawn only in the shadow map; the picture is empty outside `seen`.
TEST(SolidScene, WhatFacesTheEyeComesFirstAndLiesWithinThePartThatIsSeen) {
    const SolidScene scene = example();
    ASSERT_GT(scene.front, scene.wall);
    ASSERT_LT(scene.front, scene.triangles.size());
    ASSERT_EQ((scene.front - scene.wall) % 3, 0U);
    const double share = double(scene.front - scene.wall) / double(scene.triangles.size() - scene.wall);
    EXPECT_LT(share, 0.8);
    for (const SolidVertex& vertex : scene.triangles) {
        const Vec2 at = scene.view.to_pixels({vertex.place[0], vertex.place[1], vertex.place[2]});
        ASSERT_TRUE(at.x > scene.seen.x && at.x < scene.seen.right() && at.y > scene.seen.y &&
                    at.y < scene.seen.bottom());
    }
}

TEST(SolidScene, ABodyAtTheEyeIsSeenEverywhere) {
    MechanismShape shape;
    for (const double x : {100.0, 300.0}) {
        shape.face.push_back({x, 200}), shape.back.push_back({x, 205});
        shape.colors.push_back({0.5, 0.5, 0.5, 1});
    }
    shape.hinge = {100, 200}, shape.hub = 20, shape.pin = 6;
    const Box box{0, 0, 400, 400};
    const Perspective near = Perspective::looking(box.centre(), 30, 1, 0, 0);
    EXPECT_EQ(solid_scene(shape, palette(Theme::light), box, near, 60, 1, {}).seen.w, 400);
}

// A renderer clears the previous scene.
TEST(GlSolid, ASmallSceneAfterALargeOneLeavesNothingOfIt) {
    SKIP_WITHOUT_GL();
    SolidScene large = example(), small = example();
    small.triangles.resize(small.wall + 3);
    small.front = small.wall + 3;
    small.seen = {400, 300, 10, 10};
    const auto renderer = make_lit_renderer(960, 720), fresh = make_lit_renderer(960, 720);
    Image after, alone;
    renderer->draw(large, after);
    renderer->draw(small, after);
    fresh->draw(small, alone);
    EXPECT_TRUE(after == alone);
}

// Drawing the backs as well changes only pixels at the silhouette.
TEST(GlSolid, TheBacksOfBodiesAreNotMissed) {
    SKIP_WITHOUT_GL();
    SolidScene scene = example();
    const auto renderer = make_lit_renderer(960, 720);
    Image fronts, all;
    renderer->draw(scene, fronts);
    scene.front = scene.triangles.size();
    renderer->draw(scene, all);
    std::size_t differ = 0;
    for (std::size_t i = 0; i < all.pixels.size(); ++i) differ += all.pixels[i] != fronts.pixels[i] ? 1 : 0;
    EXPECT_LE(differ, 20U);  // of samples on the silhouette, where front and back meet
}

// The silhouette of a disc towards the light: normals that point away must not darken single pixels.
TEST(GlSolid, TheLitLimbOfADiscHasNoDarkPixels) {
    SKIP_WITHOUT_GL();
    constexpr int kSize = 400;
    MechanismShape shape;
    for (const double x : {390.0, 395.0}) {  // out of the way, as are the hub and its support
        shape.face.push_back({x, 390}), shape.back.push_back({x, 395});
        shape.colors.push_back({0.5, 0.5, 0.5, 1});
    }
    shape.hinge = {390, 390}, shape.hub = 4, shape.pin = 1;
    shape.disc = DiscShape{{200, 200}, {200, 200}, 100, 10, 0.3, {230, 200}, 5};
    const Box box{0, 0, kSize, kSize};
    const auto renderer = make_lit_renderer(kSize, kSize);
    Image out(kSize, kSize);
    for (const double yaw : {0.2, 0.35, 0.5}) {
        const Perspective view = Perspective::looking(box.centre(), 960, 0.9, yaw, 0.2);
        renderer->draw(solid_scene(shape, palette(Theme::light), box, view, 40, 1, {}), out);
        for (int y = 90; y < 190; ++y)
            for (int x = 90; x < 190; ++x) {
                const std::uint32_t pixel = out.pixels[std::size_t(y) * kSize + std::size_t(x)];
                const double alpha = (pixel >> 24) / 255.0, green = (pixel >> 8 & 255) / 255.0;
                const double away = std::hypot(x - 200.0, y - 200.0);
                if (away <= 60 || alpha <= 0.2) continue;
                ASSERT_GT(green / alpha, 0.65) << x << ", " << y << ", yaw " << yaw;
            }
    }
}

}  // namespace
}  // namespace beamcam::render
