// Meshes are closed and turned outwards: their volumes are those of the bodies.
#include "render/mechanism/mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace beamcam::render {
namespace {

Vec3 vec(const std::array<float, 3>& a) { return {a[0], a[1], a[2]}; }
Vec3 from(Vec3 a, Vec3 b) { return {b.x - a.x, b.y - a.y, b.z - a.z}; }
Vec3 cross3(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double dot3(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// By the divergence theorem; a triangle that is turned inwards counts negative.
double volume(const Mesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
        const auto at = [&](std::size_t k) { return vec(mesh.vertices[mesh.corners[i + k]].place); };
        sum += dot3(at(0), cross3(at(1), at(2))) / 6;
    }
    return sum;
}

void expect_outward_normals(const Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
        const auto vertex = [&](std::size_t k) { return mesh.vertices[mesh.corners[i + k]]; };
        const Vec3 a = vec(vertex(0).place),
                   plane = cross3(from(a, vec(vertex(1).place)), from(a, vec(vertex(2).place)));
        for (std::size_t k = 0; k < 3; ++k) EXPECT_GT(dot3(plane, vec(vertex(k).normal)), 0) << "triangle " << i / 3;
    }
}

double polygon(double radius, int sides) {
    return sides / 2.0 * radius * radius * std::sin(2 * std::numbers::pi / sides);
}

TEST(Mesh, ABoxHasItsVolume) {
    Mesh mesh;
    mesh.box({1, 2, 3}, {2, 4, 6}, {});
    EXPECT_NEAR(volume(mesh), 6, 1e-6);
    expect_outward_normals(mesh);
}

TEST(Mesh, AClosedCylinderHasItsVolumeForAnyNumberOfSides) {
    for (const int sides : {12, 20, 44, 96, 160}) {
        Mesh mesh;
        mesh.cylinder({.centre = {3, -1}, .radius = 2, .back = -1, .front = 4, .sides = sides, .closed = true}, {});
        EXPECT_NEAR(volume(mesh), 5 * polygon(2, sides), 1e-4) << sides;
        expect_outward_normals(mesh);
    }
}

// The chamfer removes the ring between a prism and a frustum. Colours of the side do not change the body.
TEST(Mesh, AChamferIsPartOfTheBody) {
    const double whole = 0.5 * polygon(2, 96), inner = polygon(1.5, 96), middle = std::sqrt(polygon(2, 96) * inner);
    const double frustum = 0.5 / 3 * (polygon(2, 96) + inner + middle);
    for (const bool colored : {false, true}) {
        Mesh mesh;
        mesh.cylinder({.centre = {}, .radius = 2, .back = 0, .front = 1, .sides = 96, .chamfer = 0.5, .closed = true},
                      {}, colored ? std::vector<Color>(7, rgb(0x123456)) : std::vector<Color>{});
        EXPECT_NEAR(volume(mesh), whole + frustum, 1e-4);
    }
}

// The front of a disc with a bore: the area between both polygons, wherever the bore is.
TEST(Mesh, TheFrontDoesNotCoverTheBore) {
    for (const double away : {0.0, 0.5, 0.72}) {
        Mesh mesh;
        mesh.cylinder({.centre = {}, .radius = 1, .back = 0, .front = 0, .sides = 160, .hole = {away, 0}, .bore = 0.25},
                      {});
        double area = 0;
        std::size_t sides = 0;  // of the bore
        for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
            const auto at = [&](std::size_t k) { return mesh.vertices[mesh.corners[i + k]]; };
            const Vec3 a = vec(at(0).place);
            if (at(0).normal[2] > 0.5) area += cross3(from(a, vec(at(1).place)), from(a, vec(at(2).place))).z / 2;
        }
        for (const MeshVertex& v : mesh.vertices)
            sides += v.normal[2] > 0.5 && std::abs(std::hypot(v.place[0] - away, v.place[1]) - 0.25) < 1e-6 ? 1 : 0;
        ASSERT_GE(sides, 12U);
        EXPECT_NEAR(area, polygon(1, 160) - polygon(0.25, static_cast<int>(sides)), 1e-5) << away;
    }
}

TEST(Mesh, ABarIsTurnedOutwardsOnWhicheverSideItsFaceIs) {
    for (const double side : {-1.0, 1.0}) {
        Mesh mesh;
        std::vector<Vec2> face, back;
        for (int i = 0; i < 5; ++i) face.push_back({i * 0.5, -side * 0.1}), back.push_back({i * 0.5, side * 0.1});
        mesh.bar(face, back, std::vector<Color>(5), 0.3);
        EXPECT_NEAR(volume(mesh), 2 * 0.2 * 0.6, 1e-6);
        expect_outward_normals(mesh);
        ASSERT_EQ(mesh.vertices.size(), 5 * Mesh::kRing + 8);
        for (std::size_t k = 0; k < 5 * Mesh::kRing; ++k)
            EXPECT_FLOAT_EQ(mesh.vertices[k].place[0], 0.5F * static_cast<float>(k / Mesh::kRing));
    }
}

}  // namespace
}  // namespace beamcam::render
