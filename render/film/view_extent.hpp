// What a mechanism's camera has to show over a film: the drawn beams at all times, the disc wherever it turns, hub and
// support, and the arrows of force. Its proportions decide how a picture is divided (layout.hpp), its camera where
// everything is drawn.
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
    // An arrow of force at a contact.
    struct ForceArrow {
        Vec2 foot, normal;  // [m]; from the cam to the beam
        double share = 0;   // of the film's largest force, 0…1
        double depth = 0;   // of the beam that stands before its label [m]
    };
    Bounds beams;                               // of all drawn beams [m]
    std::vector<const sim::Problem*> problems;  // whose discs, hubs and supports are seen; none: a square of 1 m
    std::vector<ForceArrow> arrows;
    std::vector<std::vector<Vec2>> strips;  // the beams themselves: face, back, face, back, … from the root on [m]

    // The largest camera that shows all of it in the middle of `box` [px], with a margin. `unit`: Layout::unit.
    Camera camera(const Box& box, double unit) const;
    // Width and height that it takes there, margins and all [px].
    Vec2 room(const Box& box, double unit) const;

  private:
    Bounds shown(double scale, double unit, bool small) const;
};

// The picture of this pose has an arrow of force.
bool shows_force(const sim::Pose& pose, const DrawnBeam& beam);
// A mechanism's box too small for words within it.
bool is_small(const Box& box, double unit);
// The arrow of a force with this share of the film's largest, in proportion to it [px]. `marks`: mark_unit.
double force_arrow_length(double share, bool small, double marks);
// How far from the contact its label stands, clear of a beam so deep [px].
double force_label_distance(double length, double depth, double unit);

// Of all motions of a film, beams at least so deep [m]; of a still, of the instant that it shows, with the tip's path
// if that is wanted.
ViewExtent view_extent_of(const FilmContext& context, double least_depth = 0);

}  // namespace beamcam::render
