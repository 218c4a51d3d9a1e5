// What is drawn on a mechanism beside its letters: undeflected beam, marks of the disc, traces of the contact, and the
// motions that it is compared with.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/film/mechanism_view.hpp"
#include "render/mechanism/trace.hpp"

namespace beamcam::render {

void draw_undeflected(const MechanismScene& s);
Color ink_on_disc(const MechanismScene& s);
void draw_disc_marks(const MechanismScene& s, const Trace& trace);
void draw_beam_trace(const MechanismScene& s, const Trace& trace);

// mechanism_ghosts.cpp: other motions drawn into the panel of the first one. Bodies are drawn under its beam, whose
// colours show bending, outlines over it.
void draw_ghost_bodies(const MechanismScene& s);
void draw_ghost_outlines(const MechanismScene& s);
void draw_measured_beams(const MechanismScene& s);
// The straight beam at the angle of a data set at the instant of the pose; none outside of the data.
std::optional<DrawnBeam> measured_beam(const MechanismView& at, std::size_t data, sim::Pose pose,
                                       const DrawnBeam& like);

}  // namespace beamcam::render
