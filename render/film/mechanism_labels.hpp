// The letters on a mechanism, each at a fixed place: θ outside its arc, ω and τ beside the arrows
// of the cam's speed and the hub's torque, F beyond the tip of the force's arrow. A halo keeps them readable where they
// meet a body; their numbers are in the charts and beside the clock.
#pragma once

#include <optional>
#include <vector>

#include "render/film/mechanism_view.hpp"

namespace beamcam::render {

// A contact force as it is drawn.
struct ForceArrow {
    Vec2 foot, normal;  // [m]
    double force = 0;   // [N]
};
std::optional<ForceArrow> force_arrow_of(const sim::Pose& pose, const DrawnBeam& beam);

// Hub angle as its arc shows it, without whole turns [rad].
double drawn_angle(const sim::Pose& pose);
// Largest radius of an arc about the hub's axis that stays before the disc at every angle of the cam [m].
double arc_before_cam(const sim::Problem& problem);
// Radius of the arc of θ before the camera that shows everything; none if only a hidden arc would fit [px].
std::optional<double> arc_radius(const MechanismView& home);

// The arc, which is behind the beam, and then in front of it the letter at this place.
std::optional<Vec2> draw_arc_of_angle(const MechanismScene& s);
void draw_letter_of_angle(const MechanismScene& s, Vec2 middle);
void draw_cam_speed(const MechanismScene& s);
void draw_hub_torque(const MechanismScene& s);
void draw_force(const MechanismScene& s);

}  // namespace beamcam::render
