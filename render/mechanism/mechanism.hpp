// The mechanism of one frame as shapes in pixels, shared by both painters, and its flat drawing with Cairo.
#pragma once

#include <optional>
#include <vector>

#include "render/draw/canvas.hpp"
#include "render/draw/color.hpp"
#include "render/draw/geometry.hpp"
#include "render/mechanism/exaggeration.hpp"
#include "sim/observe/pose.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::render {

struct DiscShape {
    Vec2 centre, axis;  // B, C [px]
    double radius = 0;  // [px]
    double bore = 0;    // radius of the bore about C [px]
    double angle = 0;   // of the mark, counter-clockwise [rad]
    Vec2 mark;          // centre of the drilled mark near the rim, on the ray C→B [px]
    double mark_radius = 0;
    bool operator==(const DiscShape&) const = default;
};

struct MechanismShape {
    std::vector<Vec2> face, back;  // edges of the section, root to tip [px]; the face is the touching one
    std::vector<Color> colors;     // one a station
    Vec2 hinge;                    // O [px]
    double hub = 0, pin = 0;       // radii [px]
    std::optional<DiscShape> disc;
    bool operator==(const MechanismShape&) const = default;
};

// What stays the same over a film.
struct MechanismLook {
    Camera camera;
    double unit = 1;          // of hub, bore and chamfers, which the camera magnifies with the rest [px]
    double factor = 1;        // of exaggeration
    double depth = 0;         // of the beam as drawn [m]
    double moment_scale = 0;  // colour scale ±[N m]; 0: no colouring
};

MechanismShape mechanism_shape(const sim::Problem& problem, const sim::Pose& pose, const DrawnBeam& beam,
                               const MechanismLook& look, const Palette& palette);

// The unit of hub, support, marks and their letters [px]: that of the picture, less where the drawn beam is short, so
// that they stay in proportion to it, and not below what can be read.
double mark_unit(double beam_length, double unit);
double mark_unit(const sim::Problem& problem, const Camera& camera, double unit);
// Radius of the hub's boss [px]: the hub's own where that is larger than a readable boss.
double hub_radius(const sim::Problem& problem, const Camera& camera, double unit);
// The bearing that O stands on; does not move. `reach`: how far it extends below O [px]. `marks`: mark_unit.
double support_reach(double hub_radius, double marks);
double support_half_width(double hub_radius, double marks);
// `line`: the unit of its lines [px].
void draw_support(Canvas& canvas, Vec2 hinge, double hub_radius, double marks, double line, const Palette& palette);

void draw_flat(Canvas& canvas, const MechanismShape& shape, double line, const Palette& palette);

}  // namespace beamcam::render
