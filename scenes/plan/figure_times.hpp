// The stretch of a motion that a figure shows: at once where its keys say its times, after a first look at the motion
// where events do.
#pragma once

#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

// What the figure looks at and how it is made. `how` names times alone.
void prepare_figure(FigureFile& figure, const Scene& scene, const FigureOutput& how);

bool needs_apexes(const FigureOutput& how);

// `how` with the times of its events, which `motion` has. The end of the scene is `end_time` [s]. Throws
// render::PictureError for events that the motion does not have, or has in the wrong order.
FigureOutput with_event_times(FigureOutput how, const sim::Result& motion, double end_time);

// The same, after a search of the motion whose events the figure counts: the first of those that it compares, else the
// scene's.
FigureOutput with_found_times(const FigureOutput& how, const Scene& scene, const FindEvents& find);
// Begins and ends as the scene does in place of at events: all that the figure may show.
FigureOutput without_events(FigureOutput how);

}  // namespace beamcam::scenes
