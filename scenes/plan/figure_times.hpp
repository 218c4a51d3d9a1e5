// The time interval that a figure shows. It is known from the keys, or after a first run if it begins or ends at
// events.
#pragma once

#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

// Sets the studies and the maker of the figure. `how` contains times, no events.
void prepare_figure(FigureFile& figure, const Scene& scene, const FigureOutput& how);

bool needs_apexes(const FigureOutput& how);

// Replaces the events in `how` by their times in `motion`. `end_time`: of the scene [s]. Throws render::PictureError
// for events that do not occur, or occur in the wrong order.
FigureOutput with_event_times(FigureOutput how, const sim::Result& motion, double end_time);

// The same; `find` first searches the motion whose events count: the first compared motion, else the scene's.
FigureOutput with_found_times(const FigureOutput& how, const Scene& scene, const FindEvents& find);
// Replaces events by the start and the end of the scene: the largest interval that the figure can show.
FigureOutput without_events(FigureOutput how);

}  // namespace beamcam::scenes
