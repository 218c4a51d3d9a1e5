// The mechanism at one instant, for pictures: true geometry in metres, never exaggerated.
#pragma once

#include <optional>
#include <vector>

#include "sim/base/vec2.hpp"

namespace beamcam::sim {

// The foot of the perpendicular from the cam on the centre line (S24).
struct Nearest {
    double x = 0;         // arc position on the beam, 0…L [m]
    double s = 0;         // arc on the cam, counter-clockwise from its mark [m]
    Vec2 point;           // on the cam's surface [m]
    Vec2 normal;          // n, from the cam to the beam
    double gap = 0;       // < 0: penetration [m]
    double force = 0;     // normal contact force N >= 0 [N]; 0 when apart
    double friction = 0;  // force on the beam along t (n turned by −90°) [N]
    bool touching = false;
};

struct Pose {
    double t = 0;                    // [s]
    double theta = 0;                // hub angle [rad]
    double theta_dot = 0;            // [rad/s]
    std::vector<Vec2> centreline;    // equally spaced in arc position, root first, tip last [m]
    std::vector<double> moment;      // bending moment EI κ at the same stations [N m]
    Vec2 cam_centre;                 // C (axis) [m]; meaningless without a cam
    Vec2 disc_centre;                // B of the disc that osculates the cam at the nearest point [m]
    double disc_radius = 0;          // ρ there [m]
    double cam_angle = 0;            // ψ, unwrapped [rad]; the mark lies in this direction from C
    std::optional<Nearest> nearest;  // absent without a cam
};

// At the stations, from the tangent at the root, along its normal: as the channel tip_deflection is at the tip [m].
std::vector<double> deflection(const Pose& pose);

}  // namespace beamcam::sim
