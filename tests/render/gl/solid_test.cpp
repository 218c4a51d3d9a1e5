// The bodies of the solid view and the wall that shows their shadows.
#include "render/gl/solid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/gl/lit.hpp"
#include "tests/render/drawing.hpp"

namespace beamcam::render {
namespace {

constexpr Box kBox{0, 0, 960, 720};

SolidScene example(const Perspective& view = Perspective::looking(kBox.centre(), 3000, 1, 0.3, 0.2)) {
    MechanismShape shape;
    for (int i = 0; i <= 40; ++i) {
        shape.face.push_back({100.0 + 12 * i, 500.0 - 8 * i});
        shape.back.push_back(shape.face.back() + Vec2{-10, -15});
        shape.colors.push_back({0.5, 0.5, 0.5, 1});
    }
    shape.hinge = {100, 500};
    shape.hub = 20, shape.pin = 6;
    shape.disc = DiscShape{{240, 520}, {235, 515}, 50, 10, 0.3, {270, 510}, 5};
    return solid_scene(shape, palette(Theme::light), kBox, view, 40, 1, {});
}

// Along the light to the wall.
Vec2 shadow(const std::array<float, 3>& place, double wall) {
    const double fall = (double(place[2]) - wall) / kLightNear.z;
    return {double(place[0]) - fall * kLightNear.x, double(place[1]) - fall * kLightNear.y};
}

const std::array<float, 3>& place(const SolidScene& scene, std::size_t corner) {
    return scene.mesh.vertices[scene.mesh.corners[corner]].place;
}
Vec2 pixel(const SolidScene& scene, const std::array<float, 3>& at) {
    return scene.view.to_pixels({at[0], at[1], at[2]});
}

// The parts of the wall, in pixels. Each is two triangles.
std::vector<Box> wall_of(const SolidScene& scene) {
    std::vector<Box> out;
    for (std::size_t i = 0; i < scene.wall; i += 6) {
        Bounds part;
        for (std::size_t k = i; k < i + 6; ++k) part.add(pixel(scene, place(scene, k)));
        out.push_back(part.box());
    }
    return out;
}

TEST(SolidScene, TheWallIsWhereverAShadowFallsAndNotMuchMore) {
    const SolidScene scene = example();
    ASSERT_GT(scene.wall, 0U);
    ASSERT_EQ(scene.wall % 6, 0U);
    const std::vector<Box> parts = wall_of(scene);
    const double wall = place(scene, 0)[2], blur = 0.0056 * scene.reach;
    for (std::size_t i = scene.wall; i < scene.mesh.corners.size(); ++i) {
        const Vec2 at = shadow(place(scene, i), wall);
        for (const Vec2 edge : {Vec2{0, 0}, Vec2{blur, 0}, Vec2{-blur, 0}, Vec2{0, blur}, Vec2{0, -blur}}) {
            const Vec2 px = scene.view.to_pixels({at.x + edge.x, at.y + edge.y, wall});
            ASSERT_TRUE(std::ranges::any_of(parts,
                                            [&](const Box& b) {
                                                return b.contains({px.x, px.y, 0, 0}, 1e-3);
                                            }))
                << px.x << " " << px.y;
        }
        EXPECT_GE(place(scene, i)[2], wall);  // the wall is drawn behind all
    }
    double area = 0;
    for (const Box& part : parts) area += part.w * part.h;
    EXPECT_LT(area, 0.25 * 960 * 720);
}

// The edges of its parts are those of pixels, far from all samples: no gap, and no sample belongs to two parts.
TEST(SolidScene, ThePartsOfTheWallMeetAtThePixelsEdges) {
    const SolidScene scene = example();
    for (const Box& part : wall_of(scene))
        for (const double edge : {part.x, part.y, part.right(), part.bottom()})
            ASSERT_NEAR(edge, std::round(edge), 1e-2);
}

TEST(SolidScene, TheSceneLiesWithinTheTilesThatAreSeen) {
    const SolidScene scene = example();
    for (std::size_t i = 0; i < scene.mesh.corners.size(); ++i) {
        const Vec2 at = pixel(scene, place(scene, i));
        const double around = i < scene.wall ? -1e-2 : 0;  // the wall ends at edges of tiles
        bool seen = false;
        (i < scene.wall ? scene.seen : scene.bodies)
            .for_each_run([&](double left, double top, double right, double bottom) {
                seen = seen ||
                       (at.x > left + around && at.x < right - around && at.y > top + around && at.y < bottom - around);
            });
        ASSERT_TRUE(seen) << at.x << " " << at.y;
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
    double area = 0;
    solid_scene(shape, palette(Theme::light), box, near, 60, 1, {})
        .seen.for_each_run([&](int left, int top, int right, int bottom) { area += (right - left) * (bottom - top); });
    EXPECT_EQ(area, 400 * 400);
}

// A renderer clears the previous scene.
TEST(GlSolid, ASmallSceneAfterALargeOneLeavesNothingOfIt) {
    SKIP_WITHOUT_GL();
    SolidScene large = example(), small = example();
    small.mesh.corners.resize(small.wall + 3);
    small.seen.clear();
    small.seen.add({400, 300, 10, 10});
    const auto renderer = make_lit_renderer(960, 720), fresh = make_lit_renderer(960, 720);
    Image after, alone;
    renderer->draw(large, after);
    renderer->draw(small, after);
    fresh->draw(small, alone);
    EXPECT_TRUE(after == alone);
    Image again, first;
    fresh->draw(large, again);  // its buffers grow
    make_lit_renderer(960, 720)->draw(large, first);
    EXPECT_TRUE(again == first);
}

TEST(GlSolid, BodiesAreDrawnInTheirRegionAsInTheWholePicture) {
    SKIP_WITHOUT_GL();
    const auto renderer = make_lit_renderer(960, 720);
    for (const double yaw : {-0.4, 0.0, 0.6})
        for (const double zoom : {0.4, 1.0, 5.0})  // the largest: bodies partly outside the picture
            for (const Vec2 centre : {Vec2{480, 360}, Vec2{203.3, 211.7}}) {
                SolidScene scene = example(Perspective::looking(centre, 3000, zoom, yaw, 0.2));
                Image part, whole;
                make_lit_renderer(960, 720)->draw(scene, part);
                scene.bodies.add_all();
                renderer->draw(scene, whole);
                EXPECT_TRUE(part == whole) << yaw << " " << zoom << " " << centre.x;
            }
}

// Only the wall is seen, or nothing; then bodies again.
TEST(GlSolid, BodiesMayBeOutsideThePicture) {
    SKIP_WITHOUT_GL();
    const auto renderer = make_lit_renderer(960, 720);
    const SolidScene scene = example();
    Image before, out, after;
    renderer->draw(scene, before);
    renderer->draw(example(Perspective::looking({5000, 360}, 3000, 1, 0.3, 0.2)), out);
    EXPECT_TRUE(std::ranges::all_of(out.pixels, [](std::uint32_t pixel) { return pixel == 0; }));
    renderer->draw(scene, after);
    EXPECT_TRUE(before == after);
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
