// Everything that is drawn on a mechanism: angle, speed of the cam, traces, force, captions, and the motions that it is
// compared with.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/film/mechanism_view.hpp"
#include "render/mechanism/trace.hpp"

namespace beamcam::render {

// `indent`: of the text, from the left edge of the label's box [px].
void draw_label(const MechanismScene& s, const LabelPlace& label, const std::string& text, TextStyle style, Vec2 base,
                double indent = 0);
// Draws the leader line of a label whose owner is at such a distance [design px].
inline constexpr double kFarLabel = 60;
inline constexpr double kLongestLeader = 200;  // a longer one would only cross the picture
// `text`: the box of the label's text, where the line begins.
void draw_leader(const MechanismScene& s, const LabelPlace& label, const Box& text, Color color, Vec2 owner,
                 Range lengths = {kFarLabel, kLongestLeader});

inline constexpr double kLeastArc = 0.02;  // smaller angles have no arc [rad]
// Hub angle as its arc shows it, without whole turns [rad].
double drawn_angle(const sim::Pose& pose);
// Points of the arc of θ in the flat view; `radius` before the camera that shows everything [px].
std::vector<Vec2> angle_arc(const MechanismView& at, double radius, const sim::Pose& pose);
// In the solid view, which draws no horizontal through the hinge: a short one at the start of the arc [px].
std::vector<Vec2> angle_base(const MechanismView& at, double radius);
// The arc is drawn: it is outside the hub, and the angle is not too small.
bool shows_angle_arc(const MechanismView& at, double radius, const sim::Pose& pose);
void draw_angle_arc(const MechanismScene& s);
void draw_cam_speed(const MechanismScene& s);
void draw_base_line(const MechanismScene& s);
void draw_disc_marks(const MechanismScene& s, const Trace& trace);  // on a flat or lit disc
void draw_disc_letters(const MechanismScene& s);
void draw_beam_trace(const MechanismScene& s, const Trace& trace);
// The arc of the cam's speed: its radius [px] and its angle [rad].
double speed_radius(const MechanismView& at);
double speed_gap(const MechanismView& at);  // between the arc and the circle that the disc sweeps [px]
double speed_span(const MechanismView& at);
double arrow_length(const MechanismView& at, const ForceArrow& arrow);  // [px]
TextStyle force_style(const MechanismView& at);
// The force to draw: `peak` of a contact that just ended, or else the current force.
std::optional<ForceArrow> force_arrow_of(const sim::Pose& pose, const DrawnBeam& beam,
                                         const std::optional<ForceArrow>& peak);
// The arrow's tip as seen; before a moving camera it ends inside the view if its foot is there [px].
Vec2 arrow_tip(const MechanismView& at, const Perspective* view, const ForceArrow& arrow);
void draw_force_leader(const MechanismScene& s);
void draw_force(const MechanismScene& s);
// A colour for each bin around the disc, alpha 0 if it was never touched.
std::vector<Color> rim_colors(const MechanismView& at, const Trace& trace);

// captions.cpp: the texts of events in boxes, with leader lines to their anchors.
void draw_caption_leaders(const MechanismScene& s);
void draw_captions(const MechanismScene& s);

// mechanism_ghosts.cpp: other motions drawn into the panel of the first one. Bodies are drawn under its beam, whose
// colours show bending, outlines over it.
void draw_ghost_bodies(const MechanismScene& s);
void draw_ghost_outlines(const MechanismScene& s);
void draw_measured_beams(const MechanismScene& s);
// The straight beam at the angle of a data set at the instant of the pose; none outside of the data.
std::optional<DrawnBeam> measured_beam(const MechanismView& at, std::size_t data, sim::Pose pose,
                                       const DrawnBeam& like);

}  // namespace beamcam::render
