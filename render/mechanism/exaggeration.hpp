// The beam as drawn: true, or with its deflection exaggerated so that it can be seen.
//
// True deflections are 1e-4 … 1e-2 of the length. With η(x) the distance of the centre line from a straight base
// line through the hinge O, the drawn line is (ξ, N·η) in the frame of that base line:
//   * near the cam the base is the chord O → point nearest the cam, so that a touching beam still touches there;
//   * far from it, and without a cam, it is the least-squares line through O, or the hub's own direction where the hub
//     is led (there the clamp does not give way); the change-over is smooth.
// The hinge stays. Since the drawn slope at the contact differs from the true one, the line is then turned about O
// by the small angle that makes the drawn gap equal the true one (zero where the true beam penetrates): the drawn
// beam enters the drawn cam nowhere, and the motion stays continuous through touch and release.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
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
    double gap = 0;  // of the drawing; < 0: overlap [m]
};

struct DrawnBeam {
    std::vector<Vec2> line;    // the centre line, stations as in the pose [m]
    std::vector<Vec2> left;    // unit normals, tangent turned by +90°
    double low = 0, high = 0;  // the section spans line + left·[low, high] [m]
    double side = 0;        // +1: the cam lies to the right of the beam (below), −1: to the left; between: in passing
    double base_angle = 0;  // of the base line as drawn [rad]
    std::optional<DrawnContact> contact;
    bool clear =
        true;  // false: it enters the disc, or touches it far from where the true beam does; the factor must yield

    Vec2 face(std::size_t i) const { return line[i] + left[i] * (side >= 0 ? low : high); }
    Vec2 back(std::size_t i) const { return line[i] + left[i] * (side >= 0 ? high : low); }
};

// `depth` >= the beam's is the depth drawn (a thin beam gets a visible line weight). factor >= 1. Without a cam the
// section lies about the centre line; or as that of the problem it is compared `with`, which has one.
DrawnBeam drawn_beam(const sim::Problem& problem, const sim::Pose& pose, double factor, double depth,
                     const sim::Problem* with = nullptr);

// The one factor of a film: `wanted`, or the round number that makes the largest deflection about a tenth of the
// length without tilting the contact by more than a quarter radian; 1 for a rigid beam or one that bends visibly.
// Either yields to the next smaller round number as long as some frame would show the beam in the cam.
double film_factor(const sim::Problem& problem, std::span<const sim::Pose> poses, std::optional<double> wanted);
// The same for poses that are not held at once.
double film_factor(const sim::Problem& problem, std::size_t frames,
                   const std::function<sim::Pose(std::size_t)>& pose_of, std::optional<double> wanted);
// `factor`, or the next smaller round number that shows none of the poses in the cam.
double clear_factor(const sim::Problem& problem, std::size_t frames,
                    const std::function<sim::Pose(std::size_t)>& pose_of, double factor);

}  // namespace beamcam::render
