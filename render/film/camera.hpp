// Where the camera of a mechanism looks over a film: at all of it, or nearer, at a place or after what moves.
//
// Moves between two views keep a point of the picture in its place, as a lens does that zooms in on it: the middle
// moves in proportion to the width that is seen, and the zoom geometrically.
#pragma once

#include <vector>

#include "render/draw/geometry.hpp"

namespace beamcam::render {

// A part of the mechanism, or a place of its plane.
struct Anchor {
    enum class Kind { all, tip, contact, cam, hub, place };
    Kind kind = Kind::all;  // all: the middle of what the whole film shows; contact: where beam and cam are nearest
    Vec2 place = {};        // [m]
    bool operator==(const Anchor&) const = default;
};

// What the camera shows.
struct Shot {
    double zoom = 1;      // against the camera that shows all, > 0
    Anchor follow = {};   // stands in the middle
    double yaw = 0.42;    // of the solid view: positive from the right of the plane of motion [rad], within ±1.2
    double pitch = 0.20;  // of the solid view: positive from above [rad], within ±1.2
    bool operator==(const Shot&) const = default;
};

enum class Ease { smooth, linear, in, out };

// On the way to another shot.
struct CameraMove {
    double arrives = 0;  // at this frame, counted from the film's first
    double lasts = 0;    // so many frames; from where the move before has arrived at the earliest
    Ease ease = Ease::smooth;
    Shot shot;
    bool operator==(const CameraMove&) const = default;
};

// Where everything is that a camera can follow, at one frame [m].
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

// Of every frame, in the mechanism's box; `whole`: the camera that shows all. What vibrates is followed by its mean
// over a third of a second of the film.
std::vector<CameraFrame> camera_frames(const Shot& first, const std::vector<CameraMove>& moves, const Camera& whole,
                                       const Box& box, const std::vector<Followed>& followed, double fps);

}  // namespace beamcam::render
