// The mechanism as solid bodies in perspective: meshes for the OpenGL renderer, and the projection for labels drawn
// with Cairo.
//
// Lengths are pixels: x to the right, y up, z towards the viewer, the origin at the centre of the panel. The plane z =
// 0 is the plane of motion.
#pragma once

#include <array>
#include <vector>

#include "render/draw/color.hpp"
#include "render/draw/geometry.hpp"
#include "render/mechanism/mechanism.hpp"

namespace beamcam::render {

struct Vec3 {
    double x = 0, y = 0, z = 0;
};

// A camera that looks at the origin, rotated by yaw about the vertical (positive: from the right) and by pitch
// (positive: from above).
struct Perspective {
    Vec2 centre;                    // of the picture [px]
    double distance = 1, zoom = 1;  // [px]; magnification at the origin
    std::array<Vec3, 3> axes{};     // right, up and towards the viewer

    static Perspective looking(Vec2 centre, double distance, double zoom, double yaw, double pitch);
    Vec2 to_pixels(Vec3 p) const;
};

struct SolidVertex {
    std::array<float, 3> place{}, normal{};
    std::array<float, 4> color{};  // alpha 0: the wall, which shows only shadows
};

// Axes of the light, at the upper left and in front as in the lit view: towards it, to its right, up.
inline constexpr Vec3 kLightNear{-0.4096, 0.5898, 0.6962}, kLightRight{0.8619, 0, 0.5071},
    kLightUp{0.2991, 0.8076, -0.5084};

struct SolidScene {
    Perspective view;
    std::vector<SolidVertex> triangles;  // three vertices each, in either orientation: both sides are lit
    std::size_t wall = 0;                // the first vertices: parts of the wall on which shadows may fall
    std::size_t front = 0;               // end of the triangles that face the camera; the rest only casts shadows
    double reach = 1;                    // everything is within this distance of the origin [px]
    double shadow = 0.3;                 // opacity
    Box seen;                            // the picture is transparent outside this box [px]
};

// `wide`: width of the beam across the plane of motion [px]. `rim`: colours around the disc, counter-clockwise from its
// mark, alpha 0: no colour; may be empty.
SolidScene solid_scene(const MechanismShape& shape, const Palette& palette, const Box& box, const Perspective& view,
                       double wide, double unit, const std::vector<Color>& rim);

}  // namespace beamcam::render
