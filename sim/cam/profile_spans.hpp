// The profiles of the scene as functions of the angle α of the outward normal, in smooth spans. MODEL.md (S103)–(S105).
#pragma once

#include <functional>
#include <vector>

#include "sim/cam/cam_shape.hpp"
#include "sim/cam/motion_law.hpp"

namespace beamcam::sim {

// A part of the outline over which h is smooth.
struct ProfileSpan {
    double from = 0, to = 0;             // of α [rad], from < to
    std::function<CamPoint(double)> at;  // exact to rounding; the formula continues a little beyond the ends
};

// The spans follow one another over a turn of α, which begins anywhere. Each needs a profile without errors of
// `check_profile`, or else returns spans with a negative ρ, an empty list or an unclosed one, but always returns.
std::vector<ProfileSpan> spans_of(const LawProfile& profile, Vec2 centre, double offset);
std::vector<ProfileSpan> spans_of(const ArcsProfile& profile);
std::vector<ProfileSpan> spans_of(const PointsProfile& profile);
std::vector<ProfileSpan> spans_of(const Problem& problem);  // whose cam has a profile

// The point of the outline that a straight lever touches when it moves like this (S103). `centre` is C from the lever's
// pivot, `offset` d, `side` σ.
CamPoint touched_point(const LeverMotion& motion, Vec2 centre, double offset, double side);
// σ of the lever for which the outline is made: 1 where its lowest angle lies counter-clockwise from C, else −1.
double side_of(const LawProfile& profile, Vec2 centre);

// The arcs, changed least so that each is exactly tangent to the next (S104).
std::vector<Arc> closed_arcs(const ArcsProfile& profile);
// The angle α of the normal in which an arc touches the next.
double joint_angle(const Arc& arc, const Arc& next);

// The points without a repeated last one, counter-clockwise, and the angle of the normal of each, which increases where
// the outline is convex (S105).
struct OrientedPoints {
    std::vector<Vec2> points;
    std::vector<double> normals;
};
OrientedPoints oriented(const PointsProfile& profile);

}  // namespace beamcam::sim
