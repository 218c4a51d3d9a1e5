// The bodies of a mechanism, their order, shadows and edges.
#include "render/gl/bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/gl/renderer.hpp"
#include "render/mechanism/mechanism.hpp"
#include "tests/render/drawing.hpp"

namespace beamcam::render {
namespace {

constexpr Box kBox{0, 0, 960, 720};
const Stage kStage{kBox, kBox.centre(), Ground::wall, 40};

// The beam is red.
MechanismShape mechanism() {
    MechanismShape shape;
    for (int i = 0; i <= 40; ++i) {
        shape.face.push_back({100.0 + 12 * i, 500.0 - 8 * i});
        shape.back.push_back(shape.face.back() + Vec2{-10, -15});
        shape.colors.push_back({1, 0, 0, 1});
    }
    shape.hinge = {100, 500}, shape.floor = 640;
    shape.hub = 20, shape.pin = 6;
    shape.disc = DiscShape{{240, 470}, {235, 465}, 50, 10, 0.3, {270, 460}, 5};
    shape.touch = {{212, 428}, {-0.55, -0.83}};
    return shape;
}

Projection looking(double yaw, double pitch) { return Projection::looking(kBox.centre(), 3000, 1, yaw, pitch); }

BodyScene scene_of(const MechanismShape& shape, const Projection& view, Ground ground = Ground::wall) {
    Stage stage = kStage;
    stage.ground = ground;
    return body_scene(shape, palette(Theme::light), stage, view);
}

std::uint32_t alpha_at(const Image& image, int x, int y) { return pixel_at(image, x, y) >> 24; }

TEST(BodyScene, LiesWithinTheTilesThatAreSeen) {
    for (const Ground ground : {Ground::wall, Ground::floor}) {
        const BodyScene scene = scene_of(mechanism(), looking(0.3, 0.2), ground);
        std::vector<std::array<float, 2>> points;
        for (const BodyVertex& v : scene.vertices) points.push_back(v.pixel);
        for (const ShadowVertex& v : scene.shadows) points.push_back(v.pixel);
        for (const auto& [x, y] : points) {
            bool seen = x < 0 || y < 0 || x >= 960 || y >= 720;
            scene.seen.for_each_run([&](float left, float top, float right, float bottom) {
                seen = seen || (x >= left && x <= right && y >= top && y <= bottom);
            });
            ASSERT_TRUE(seen) << x << " " << y;
        }
    }
}

// The camera is above or below the plane that separates beam and cam.
TEST(BodyScene, TheNearerOfBeamAndCamIsDrawnLater) {
    for (const double pitch : {-0.7, 0.7}) {
        const BodyScene scene = scene_of(mechanism(), looking(0, pitch));
        std::size_t beam = 0, cam = 0;
        for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
            const auto& c = scene.vertices[i].color;
            if (c[0] == 1 && c[1] == 0) beam = i;
            if (std::abs(c[0] - 0x5B / 255.0F) < 1e-6 && std::abs(c[1] - 0x66 / 255.0F) < 1e-6) cam = i;
        }
        EXPECT_EQ(beam > cam, pitch > 0) << beam << " " << cam;
    }
}

TEST(GlBodies, ShadowsAreFaintAndFadeAtTheEdgesOfThePicture) {
    SKIP_WITHOUT_GL();
    for (const Ground ground : {Ground::wall, Ground::floor}) {
        const Projection view = ground == Ground::wall ? Projection::front(kBox.centre()) : looking(0.4, 0.2);
        BodyScene scene = scene_of(mechanism(), view, ground);
        scene.corners.clear();  // shadows alone
        Image image;
        make_body_renderer(960, 720)->draw(scene, image);
        std::uint32_t most = 0;
        for (int y = 0; y < 720; ++y)
            for (int x = 0; x < 960; ++x) {
                most = std::max(most, alpha_at(image, x, y));
                if (x == 0 || y == 0 || x == 959 || y == 719) {
                    ASSERT_LE(alpha_at(image, x, y), 1U);
                }
            }
        EXPECT_GT(most, 25U);
        EXPECT_LE(most, ground == Ground::wall ? 37U : 52U);  // 0.14 or 0.2 of 255, and the noise
    }
}

// Along an edge that rises by a sixteenth, coverage is that of the exact area within a sixteenth.
TEST(GlBodies, EdgesAreSmootherThanEightSamples) {
    SKIP_WITHOUT_GL();
    MechanismShape shape = mechanism();
    shape.disc.reset(), shape.touch.reset();
    for (std::size_t i = 0; i < shape.face.size(); ++i) {
        shape.face[i] = {300 + 12.0 * double(i), 350.3 - 0.75 * double(i)};
        shape.back[i] = shape.face[i] - Vec2{1.875, 30};
    }
    shape.hinge = {300, 340};
    Image image;
    make_body_renderer(960, 720)->draw(scene_of(shape, Projection::front(kBox.centre()), Ground::none), image);
    for (int x = 400; x < 700; ++x) {
        const double edge = 350.3 - (x + 0.5 - 300) / 16;
        for (int y = int(edge) - 2; y <= int(edge) + 2; ++y)
            ASSERT_NEAR(alpha_at(image, x, y) / 255.0, std::clamp(edge - y, 0.0, 1.0), 1.0 / 16) << x << ", " << y;
    }
}

// A renderer clears the previous scene.
TEST(GlBodies, ASceneLeavesNothingOfThePreviousOne) {
    SKIP_WITHOUT_GL();
    const BodyScene large = scene_of(mechanism(), looking(0.3, 0.2), Ground::floor),
                    out = scene_of(mechanism(), Projection::looking({5000, 360}, 3000, 1, 0.3, 0.2));
    const auto renderer = make_body_renderer(960, 720);
    Image before, nothing, after;
    renderer->draw(large, before);
    renderer->draw(out, nothing);
    EXPECT_TRUE(std::ranges::all_of(nothing.pixels, [](std::uint32_t pixel) { return pixel == 0; }));
    renderer->draw(large, after);
    EXPECT_TRUE(before == after);
}

// The silhouette of a disc towards the light: normals that point away must not darken single pixels.
TEST(GlBodies, TheLitLimbOfADiscHasNoDarkPixels) {
    SKIP_WITHOUT_GL();
    constexpr int kSize = 400;
    MechanismShape shape;
    for (const double x : {390.0, 395.0}) {  // out of the way, as are the hub and its support
        shape.face.push_back({x, 390}), shape.back.push_back({x, 395});
        shape.colors.push_back({0.5, 0.5, 0.5, 1});
    }
    shape.hinge = {390, 390}, shape.hub = 4, shape.pin = 1, shape.floor = 395;
    shape.disc = DiscShape{{200, 200}, {200, 200}, 100, 10, 0.3, {230, 200}, 5};
    const Box box{0, 0, kSize, kSize};
    const auto renderer = make_body_renderer(kSize, kSize);
    Image out(kSize, kSize);
    for (const double yaw : {0.2, 0.35, 0.5}) {
        const Projection view = Projection::looking(box.centre(), 960, 0.9, yaw, 0.2);
        renderer->draw(body_scene(shape, palette(Theme::light), {box, box.centre(), Ground::none, 40}, view), out);
        for (int y = 90; y < 190; ++y)
            for (int x = 90; x < 190; ++x) {
                const std::uint32_t pixel = out.pixels[std::size_t(y) * kSize + std::size_t(x)];
                const double alpha = (pixel >> 24) / 255.0, green = (pixel >> 8 & 255) / 255.0;
                const double away = std::hypot(x - 200.0, y - 200.0);
                if (away <= 60 || alpha <= 0.2) continue;
                ASSERT_GT(green / alpha, 0.35) << x << ", " << y << ", yaw " << yaw;
            }
    }
}

}  // namespace
}  // namespace beamcam::render
