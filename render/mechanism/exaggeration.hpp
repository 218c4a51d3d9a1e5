// The shape of the beam as drawn, with exaggerated deflection.
//
// True deflections are 1e-4 … 1e-2 of the length. With η(x) the distance of the centre line from a straight base
// line through the hinge O, the drawn line is (ξ, N·η) in the frame of that base line:
//   * near the cam, the base is the chord O → point nearest the cam, so that a touching beam still touches there;
//   * far from the cam, or without one, it is the least-squares line through O, or the direction of the hub if the hub
//   is
//     prescribed. The transition is smooth.
// The section extends away from the cam, so that nothing overlaps; that of a beam that points away from the cam is
// centred on the hinge, and the transition is smooth again.
// The hinge is fixed. Since the drawn slope at the contact differs from the true one, the line is then rotated about O
// by the small angle that makes the drawn gap equal to the true one (zero if the true beam penetrates): the drawn beam
// never enters the drawn cam, and the motion stays continuous through touch and release.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "render/draw/geometry.hpp"
#include "sim/observe/pose.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::render {

struct DrawnContact {
    Vec2 on_disc;    // nearest point of the disc's surface [m]
    Vec2 on_face;    // nearest point of the drawn beam's touching face [m]
    Vec2 normal;     // from the cam to the beam
    double x = 0;    // arc position on the beam [m]
    double gap = 0;  // in the drawing; < 0: overlap [m]
};

struct DrawnBeam {
    std::vector<Vec2> line;    // the centre line, stations as in the pose [m]
    std::vector<Vec2> left;    // unit normals, tangent turned by +90°
    double low = 0, high = 0;  // the section spans line + left·[low, high] [m]
    // +1: the cam is to the right of the beam (below), −1: to the left; between: in transition; 0: nowhere near
    double side = 0;
    double base_angle = 0;  // of the drawn base line [rad]
    std::optional<DrawnContact> contact;
    bool clear = true;  // false: it enters the disc, or touches it far from the true contact; the factor is too large

    Vec2 face(std::size_t i) const { return line[i] + left[i] * (side >= 0 ? low : high); }
    Vec2 back(std::size_t i) const { return line[i] + left[i] * (side >= 0 ? high : low); }
};

// `depth`: drawn depth, >= the beam's (a thin beam gets a visible line width). factor >= 1. Without a cam the section
// is centred on the centre line, or placed as in the problem `reference`, which has a cam.
DrawnBeam drawn_beam(const sim::Problem& problem, const sim::Pose& pose, double factor, double depth,
                     const sim::Problem* reference = nullptr);

// The factor of a film: `requested`, or the round number up to 50 that makes the largest deflection about a tenth of
// the length without tilting the contact by more than a quarter radian; 1 for a rigid beam or visible bending. The
// factor is reduced to the next smaller round number until no frame shows the beam inside the cam.
double film_factor(const sim::Problem& problem, std::size_t frames,
                   const std::function<sim::Pose(std::size_t)>& pose_of, std::optional<double> requested);
// `factor`, or the largest smaller round number with which no pose shows the beam inside the cam.
double clear_factor(const sim::Problem& problem, std::size_t frames,
                    const std::function<sim::Pose(std::size_t)>& pose_of, double factor);

}  // namespace beamcam::render
