// The extent of a mechanism over a film: the drawn beams at all times, the circles that discs sweep, hub and support,
// and the arrows of force. The camera follows from it.
//
// Hub, support and arrows have sizes in pixels, so that the proportions depend a little on the box.
#pragma once

#include <vector>

#include "render/draw/geometry.hpp"
#include "render/mechanism/exaggeration.hpp"
#include "sim/observe/pose.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::render {

struct FilmContext;

struct ViewExtent {
    struct ForceArrow {
        Vec2 foot, normal;  // [m]; from the cam to the beam
        double share = 0;   // fraction of the largest force of all frames, 0…1
        double depth = 0;   // depth of the beam between contact and label [m]
    };
    Bounds beams;                               // of the drawn beams [m]
    std::vector<const sim::Problem*> problems;  // with the visible discs, hubs and supports; none: a square of 1 m
    std::vector<ForceArrow> arrows;
    bool turned = false;                    // some beam points to the left, and the arc of θ goes around the hub
    std::vector<std::vector<Vec2>> strips;  // the beams: face, back, face, back, … from the root on [m]

    // The camera with the largest scale that shows everything, centred in `box` [px] with a margin. `unit`:
    // Layout::unit.
    Camera camera(const Box& box, double unit) const;

  private:
    Bounds shown(double scale, double unit, bool small) const;
};

// The drawing of this pose has an arrow of force.
bool shows_force(const sim::Pose& pose, const DrawnBeam& beam);
// The box of a mechanism is too small for labels.
bool is_small(const Box& box, double unit);
// … or large enough for the names of motions.
bool has_names(const Box& box, double unit);
// Smallest radius of the arc of θ around a hub of this radius [px]. `marks`: mark_unit.
double least_arc(double hub, double marks);
// Distance of the arrow of a torque from the hub [px].
inline double torque_arrow_distance(double unit) { return 18 * unit; }
// Length of the arrow of a force with this fraction of the film's largest [px]. `marks`: mark_unit.
double force_arrow_length(double share, bool small, double marks);
// Distance of the letter of a force from the contact, clear of the arrow and of a beam of this depth [px].
double force_label_distance(double length, double depth, double unit);

// The extent of all motions of a film, with beams drawn at least this deep [m]; for a still, the extent at its instant,
// with the tip's path if the view shows it.
ViewExtent view_extent_of(const FilmContext& context, double least_depth = 0);

}  // namespace beamcam::render
