// Motion of the cam, and depths of impacts, from a problem's numbers.
#pragma once

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

struct CamPose {
    double angle = 0;  // ψ [rad]
    Vec2 disc;         // B [m]
    Vec2 velocity;     // Ḃ [m/s]
};
CamPose cam_pose(const Cam& cam, double t);
inline Vec2 disc_centre(const Cam& cam, double t) { return cam_pose(cam, t).disc; }

// Deepest penetration of a mass at this speed on a contact F = K δⁿ, [(n+1) m v²/(2K)]^{1/(n+1)} [m] (S37).
double impact_depth(double exponent, double stiffness, double mass, double speed);

}  // namespace beamcam::sim
