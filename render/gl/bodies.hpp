// The mechanism as solid bodies with soft shadows, for the OpenGL renderer. The lit view is the parallel projection
// from the front; the solid view is a perspective. Coordinates are those of Projection.
#pragma once

#include <array>
#include <vector>

#include "render/draw/dirty_tiles.hpp"
#include "render/mechanism/body_mesh.hpp"

namespace beamcam::render {

struct MechanismShape;

// Depths of the bodies, from the plane of motion, relative to the width of the beam.
inline constexpr double kDiscDepth = 0.62, kHubDepth = 0.7, kMountDepth = 1.5;

// A corner of a soft shadow or of the floor, which are triangles of the picture under the bodies.
struct ShadowVertex {
    std::array<float, 2> pixel{};
    // Distances inwards from both sides and from both ends, relative to the penumbra; −1: outside, 1: inside.
    std::array<float, 4> inside{};
    float opacity = 0, grey = 0;
};

// The beam has the colours of its moment, between which it is satin aluminium.
struct Materials {
    Color cam, track, housing, pin, bracket;
};
Materials materials(const Palette& palette);

// What catches the shadows.
enum class Ground { none, wall, floor };

// What is the same for all poses before one camera.
struct Stage {
    Box box;      // of the picture [px]
    Vec2 middle;  // of the panel, which is the origin of the bodies [px]
    Ground ground = Ground::wall;
    double wide = 0;  // width of the beam across the plane of motion [px]
    double unit = 1;  // design pixel [px]
};

struct BodyScene {
    std::vector<BodyVertex> vertices;
    std::vector<std::uint32_t> corners;
    std::vector<ShadowVertex> shadows;  // under the bodies
    Vec3 eye{};                         // from which highlights are seen
    double fade = 60;                   // width in which shadows fade out at the edges of the picture [px]
    DirtyTiles seen{};                  // the tiles of bodies and shadows; the rest of the picture is transparent
};

BodyScene body_scene(const MechanismShape& shape, const Palette& palette, const Stage& stage, const Projection& view);

}  // namespace beamcam::render
