// The mechanism as solid bodies in perspective: meshes for the OpenGL renderer, and the projection for labels drawn
// with Cairo.
//
// Lengths are pixels: x to the right, y up, z towards the viewer, the origin at the centre of the panel. The plane z =
// 0 is the plane of motion.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "render/draw/color.hpp"
#include "render/draw/dirty_tiles.hpp"
#include "render/draw/geometry.hpp"
#include "render/mechanism/mechanism.hpp"
#include "render/mechanism/mesh.hpp"

namespace beamcam::render {

// A camera that looks at the origin, rotated by yaw about the vertical (positive: from the right) and by pitch
// (positive: from above).
struct Perspective {
    Vec2 centre;                    // of the picture [px]
    double distance = 1, zoom = 1;  // [px]; magnification at the origin
    std::array<Vec3, 3> axes{};     // right, up and towards the viewer

    static Perspective looking(Vec2 centre, double distance, double zoom, double yaw, double pitch);
    bool operator==(const Perspective&) const = default;
    Vec2 to_pixels(Vec3 p) const;
    bool is_before(Vec3 p) const;                          // clearly in front of the camera
    std::optional<Vec3> seen_at(Vec2 px, double z) const;  // the point of the plane z = const. at this pixel
};

// Axes of the light, at the upper left and in front as in the lit view: towards it, to its right, up.
inline constexpr Vec3 kLightNear{-0.4096, 0.5898, 0.6962}, kLightRight{0.8619, 0, 0.5071},
    kLightUp{0.2991, 0.8076, -0.5084};

// Depths of the bodies, from the plane of motion, and of the wall behind them, relative to the width of the beam.
inline constexpr double kDiscDepth = 0.62, kHubDepth = 0.7, kMountDepth = 1.5, kWallDepth = -1.55;

struct SolidScene {
    Perspective view;
    Mesh mesh;             // the nearest bodies come first among the bodies, so that hidden pixels are not shaded
    std::size_t wall = 0;  // the first corners: parts of the wall on which shadows may fall
    double reach = 1;      // everything is within this distance of the origin [px]
    double shadow = 0.3;   // opacity
    double fade = 60;      // width in which shadows fade out at the edges of the picture [px]
    DirtyTiles bodies;     // the tiles that bodies cover
    DirtyTiles seen;       // these and the wall's; the rest of the picture is transparent
};

// `wide`: width of the beam across the plane of motion [px]. `rim`: colours around the disc, counter-clockwise from its
// mark, alpha 0: no colour; may be empty.
SolidScene solid_scene(const MechanismShape& shape, const Palette& palette, const Box& box, const Perspective& view,
                       double wide, double unit, const std::vector<Color>& rim);

}  // namespace beamcam::render
