// Triangles of bodies cover what a camera sees of them, and their edges fade over a pixel.
#include "render/mechanism/body_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beamcam::render {
namespace {

Vec2 px(const BodyMesh& mesh, std::size_t corner) {
    const BodyVertex& v = mesh.vertices[mesh.corners[corner]];
    return {v.pixel[0], v.pixel[1]};
}
double cover(const BodyMesh& mesh, std::size_t corner) { return mesh.vertices[mesh.corners[corner]].color[3]; }

// The integral of the coverage; triangles do not overlap when a single front is seen.
double covered_area(const BodyMesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.corners.size(); i += 3)
        sum += std::abs(cross(px(mesh, i + 1) - px(mesh, i), px(mesh, i + 2) - px(mesh, i))) / 6 *
               (cover(mesh, i) + cover(mesh, i + 1) + cover(mesh, i + 2));
    return sum;
}

// How much of the background is hidden at a point.
double hidden(const BodyMesh& mesh, Vec2 p) {
    double shown = 1;
    for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
        const Vec2 a = px(mesh, i), b = px(mesh, i + 1), c = px(mesh, i + 2);
        const double all = cross(b - a, c - a), u = cross(b - p, c - p) / all, v = cross(c - p, a - p) / all;
        if (std::abs(all) < 1e-9 || u < 0 || v < 0 || u + v > 1) continue;
        shown *= 1 - (u * cover(mesh, i) + v * cover(mesh, i + 1) + (1 - u - v) * cover(mesh, i + 2));
    }
    return 1 - shown;
}

// Distance of a point inwards from the convex hull of others.
double inside_hull(const std::vector<Vec2>& points, Vec2 p) {
    double least = 1e9;
    for (int k = 0; k < 720; ++k) {
        const Vec2 way = sim::unit(k * std::numbers::pi / 360);
        double support = -1e9;
        for (const Vec2& q : points) support = std::max(support, dot(way, q - p));
        least = std::min(least, support);
    }
    return least;
}

Prism standing(Prism p) {
    p.back = -20, p.front = 25, p.chamfer = 2;
    return p;
}
const std::array kTrapezium{Vec2{-40, -10}, Vec2{50, -12}, Vec2{30, 35}, Vec2{-20, 30}};

TEST(BodyMesh, AFrontCoversItsAreaAndFadesOverAPixel) {
    const Projection front = Projection::front({100, 100});
    BodyMesh square(front), disc(front);
    square.add(standing(block(std::array{Vec2{-20, -20}, Vec2{20, -20}, Vec2{20, 20}, Vec2{-20, 20}})), {});
    EXPECT_NEAR(covered_area(square), 40 * 40 + 1.0 / 3, 1e-3);  // ∫ (40 + 2t)² dt over the pixel
    disc.add(standing(cylinder({3, 4}, 30)), {});
    const auto n = static_cast<double>(cylinder({}, 30).outline.size());
    const double polygon = n / 2 * 900 * std::sin(2 * std::numbers::pi / n);
    EXPECT_GT(polygon, 0.997 * std::numbers::pi * 900);
    EXPECT_NEAR(covered_area(disc), polygon + std::numbers::pi / 12, 0.01);
    // Linear across the edge, a half on it.
    for (const double off : {-0.4, -0.2, 0.0, 0.3}) EXPECT_NEAR(hidden(square, {120 + off, 101}), 0.5 - off, 1e-4);
}

TEST(BodyMesh, ABodyCoversItsProjectionFromAllSides) {
    Bar bar{{}, {}, std::vector<Color>(9), 15, 1.5, 0.1};
    for (int i = 0; i < 9; ++i)
        bar.low.push_back({10.0 * i - 40, 2.0 * i}), bar.high.push_back(bar.low[i] + Vec2{-3, 15});
    for (const double yaw : {-1.1, -0.3, 0.0, 0.5, 1.1})
        for (const double pitch : {-0.9, 0.0, 0.2, 0.9}) {
            const Projection view = Projection::looking({100, 100}, 700, 1, yaw, pitch);
            const auto expect_covered = [&](const BodyMesh& mesh, const std::vector<Vec2>& outline, double back,
                                            double front) {
                std::vector<Vec2> seen;
                for (const Vec2 p : outline)
                    for (const double z : {back, front}) seen.push_back(view.to_pixels({p.x, p.y, z}));
                for (double x = 25; x < 175; x += 3.7)
                    for (double y = 25; y < 175; y += 3.9) {
                        const double depth = inside_hull(seen, {x, y}), part = hidden(mesh, {x, y});
                        if (depth > 1.5) {
                            EXPECT_GT(part, 0.99) << x << "," << y << " yaw " << yaw << " pitch " << pitch;
                        }
                        if (depth < -1.5) {
                            EXPECT_EQ(part, 0) << x << "," << y << " yaw " << yaw << " pitch " << pitch;
                        }
                    }
            };
            for (const Prism& p : {standing(block(kTrapezium)), standing(cylinder({5, 5}, 30))}) {
                BodyMesh mesh(view);
                mesh.add(p, {});
                expect_covered(mesh, p.outline, p.back, p.front);
            }
            BodyMesh mesh(view);
            mesh.add(bar);
            // The root, which its clamp covers, has no end.
            if (yaw >= 0) expect_covered(mesh, {bar.low[0], bar.low[8], bar.high[8], bar.high[0]}, -15, 15);
        }
}

TEST(BodyMesh, NormalsAreTurnedTowardsTheCamera) {
    const Projection view = Projection::looking({100, 100}, 700, 1, 0.6, 0.4);
    BodyMesh mesh(view);
    mesh.add(standing(block(kTrapezium)), {});
    mesh.add(standing(cylinder({5, 5}, 30)), {});
    for (const BodyVertex& v : mesh.vertices) {
        const Vec3 n{v.normal[0], v.normal[1], v.normal[2]};
        EXPECT_NEAR(dot(n, n), 1, 1e-6);
        EXPECT_GT(dot(n, view.towards_camera({v.at[0], v.at[1], v.at[2]})), -0.12);  // limbs are polygons
    }
}

}  // namespace
}  // namespace beamcam::render
