// The shapes of the mechanism in pixels, used by all styles, and their flat drawing.
#pragma once

#include <limits>
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
    Vec2 centre, axis;  // B, C [px]; both C for a cam with a profile
    double radius = 0;  // [px]; of a cam with a profile that of the circle about C that it sweeps
    double bore = 0;    // radius of the bore about C [px]
    double angle = 0;   // of the mark, counter-clockwise [rad]
    Vec2 mark;          // centre of the drilled mark near the rim, on the ray C→B [px]
    double mark_radius = 0;
    // Smallest radius of curvature; lines along the edge are at most half of it inside [px].
    double sharpest = std::numeric_limits<double>::infinity();
    // Of a cam with a profile: points at equal distances along it from where contact_s is 0, and the outward normals.
    std::vector<Vec2> outline = {}, outward = {};  // [px], counter-clockwise in the fixed axes; of length 1, y down
    bool operator==(const DiscShape&) const = default;

    // The point of the outline at that share of its length, moved inwards [px].
    Vec2 rim(double share, double inset) const;
};

struct MechanismShape {
    std::vector<Vec2> face, back;  // edges of the section, root to tip [px]; the face is on the cam's side
    std::vector<Color> colors;     // one per station
    Vec2 hinge;                    // O [px]
    double hub = 0, pin = 0;       // radii [px]
    double floor = 0;              // on which the brackets of hub and cam stand [px]
    std::optional<DiscShape> disc;
    struct Touch {
        Vec2 at;      // on the cam, where it is nearest to the beam [px]
        Vec2 normal;  // from the cam to the beam, y down
        bool operator==(const Touch&) const = default;
    };
    std::optional<Touch> touch;
    // A trapezoid from the shaft that it carries down to a plate on the floor.
    struct Bracket {
        Vec2 shaft;                // [px]
        double top = 0, foot = 0;  // half of its width at the shaft, and of the plate [px]
        bool operator==(const Bracket&) const = default;
    };
    std::vector<Bracket> brackets;  // of hub and cam
    bool operator==(const MechanismShape&) const = default;
};

// Camera and scales of the drawing; constant over a film unless the camera moves.
struct MechanismLook {
    Camera camera;
    double unit = 1;          // size of a design pixel of hub, bore and chamfers, which grow with the zoom [px]
    double factor = 1;        // exaggeration of deflection
    double depth = 0;         // drawn depth of the beam [m]
    double moment_scale = 0;  // end of the colours' √ scale; 0: no colouring [N m]
};

MechanismShape mechanism_shape(const sim::Problem& problem, const sim::Pose& pose, const DrawnBeam& beam,
                               const MechanismLook& look, const Palette& palette);

// Size of a design pixel of hub, support, marks and their letters [px]: that of the picture, reduced for a short drawn
// beam, so that they stay in proportion to it, down to the readable minimum.
double mark_unit(double beam_length, double unit);
double mark_unit(const sim::Problem& problem, const Camera& camera, double unit);
// Radius of a hub that covers the corners of the beam's root [m].
double root_radius(const sim::Problem& problem);
// Drawn radius of the hub [px]: at least that of a visible boss.
double hub_radius(const sim::Problem& problem, const Camera& camera, double unit);
// The fixed bearing below O. `support_reach`: its extent below O [px]. `marks`: mark_unit.
double support_reach(double hub_radius, double marks);
double support_half_width(double hub_radius, double marks);
// Distance from O down to the floor, which is below that support and below the circle that the cam sweeps [px].
double floor_depth(const sim::Problem& problem, const Camera& camera, double unit);
// `line`: size of a design pixel of its lines [px].
void draw_support(Canvas& canvas, Vec2 hinge, double hub_radius, double marks, double line, const Palette& palette);

void draw_flat(Canvas& canvas, const MechanismShape& shape, double line, const Palette& palette);

}  // namespace beamcam::render
