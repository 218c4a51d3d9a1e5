// What is written on a mechanism: angle, speed of the cam, traces, force, words.
#pragma once

#include <optional>
#include <vector>

#include "render/film/mechanism_view.hpp"
#include "render/mechanism/trace.hpp"

namespace beamcam::render {

inline constexpr double kReadable = 9;  // the least size of letters in any picture [px]

// As its arc shows it: in the sense in which the hub has turned, without whole turns [rad].
double drawn_angle(const sim::Pose& pose);
void draw_angle_arc(const MechanismScene& s);
void draw_cam_speed(const MechanismScene& s);
void draw_base_line(const MechanismScene& s);
void draw_disc_marks(const MechanismScene& s, const Trace& trace);  // of a flat or lit disc
void draw_disc_letters(const MechanismScene& s);
void draw_beam_trace(const MechanismScene& s, const Trace& trace);
// Of the arc about the disc that tells its speed: its radius [px] and its angle [rad].
double speed_radius(const MechanismView& at);
double speed_gap(const MechanismView& at);  // between the circle that the disc sweeps and the arc [px]
double speed_span(const MechanismView& at);
double arrow_length(const MechanismView& at, const ForceArrow& arrow);  // [px]
TextStyle force_style(const MechanismView& at);
// The force of this instant; in place of none, or of one that does not last, that of a contact just over.
std::optional<ForceArrow> force_arrow_of(const sim::Pose& pose, const DrawnBeam& beam,
                                         const std::optional<ForceArrow>& peak);
void draw_force(const MechanismScene& s);
// A colour for each place around the disc, none where it was never touched.
std::vector<Color> rim_colors(const MechanismView& at, const Trace& trace, double now);

}  // namespace beamcam::render
