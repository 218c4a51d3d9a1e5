// The moving camera of a mechanism panel: zoom, a fixed point or a part to follow, and keyframes.
//
// Between two keyframes the zoom changes geometrically and the centre in proportion to the visible width; so one point
// of the picture stays fixed, as with a zoom lens.
#pragma once

#include <vector>

#include "render/draw/geometry.hpp"

namespace beamcam::render {

// A part of the mechanism, or a fixed point.
struct Anchor {
    enum class Kind { all, tip, contact, cam, hub, place };
    Kind kind = Kind::all;  // all: the centre of the full view; contact: the point nearest to both beam and cam
    Vec2 place = {};        // [m]
    bool operator==(const Anchor&) const = default;
};

// Settings of the camera.
struct Shot {
    double zoom = 1;      // relative to the camera that shows everything, > 0
    Anchor follow = {};   // at the centre; the tip a little outside it
    double yaw = 0.42;    // solid view: positive from the right of the plane of motion [rad], within ±1.2
    double pitch = 0.20;  // solid view: positive from above [rad], within ±1.2
    bool operator==(const Shot&) const = default;
};

enum class Ease { smooth, linear, in, out };

// A keyframe: the move to another shot.
struct CameraMove {
    double arrives = 0;  // frame at which the shot is reached, counted from the film's first
    double lasts = 0;    // number of frames; the move starts when the previous one has arrived at the earliest
    Ease ease = Ease::smooth;
    Shot shot;
    bool operator==(const CameraMove&) const = default;
};

// Positions at one frame of the parts that a camera can follow [m].
struct Followed {
    Vec2 tip, contact, cam;
};

// The camera at one frame.
struct CameraFrame {
    Camera camera;
    double zoom = 1, yaw = 0, pitch = 0;
    bool operator==(const CameraFrame& o) const {
        return camera.scale == o.camera.scale && camera.origin == o.camera.origin && yaw == o.yaw && pitch == o.pitch;
    }
};

// The camera of every frame, for the mechanism's box. `whole`: the camera that shows everything. Followed parts are
// averaged over a third of a second, so that the camera does not vibrate with them.
std::vector<CameraFrame> camera_frames(const Shot& first, const std::vector<CameraMove>& moves, const Camera& whole,
                                       const Box& box, const std::vector<Followed>& followed, double fps);

}  // namespace beamcam::render
