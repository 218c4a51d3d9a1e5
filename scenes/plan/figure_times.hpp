// The stretch of a motion that a figure shows: at once where its keys say its times, after a first look at the motion
// where events do.
#pragma once

#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

// What the figure looks at and how it is made. `how` names times alone.
void prepare_figure(FigureFile& figure, const Scene& scene, const FigureOutput& how);

// The motion whose events a figure counts: the first of those that it compares, else the scene's.
const sim::Problem& counted_motion(const Scene& scene, const FigureOutput& how);
bool looks_at_apexes(const FigureOutput& how);

// `how` with the times of its events, which `motion` has. The end of the scene is `end_time` [s]. Throws
// render::PictureError for events that the motion does not have, or has in the wrong order.
FigureOutput with_event_times(FigureOutput how, const sim::Result& motion, double end_time);

}  // namespace beamcam::scenes
