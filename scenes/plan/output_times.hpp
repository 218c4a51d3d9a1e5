// The times of pictures and figures. They are known from the keys, or after a first run of a motion that finds the
// times of its events and ends as soon as the needed ones are found (resolve_event_times in plan.hpp).
#pragma once

#include "scenes/plan/plan.hpp"
#include "scenes/scene/film_times.hpp"

namespace beamcam::scenes {

// `motion` contains the events; it is empty for pictures whose times are known.
FilmTimes times_of(const Pictures& p, const sim::Result& motion);
// Chooses the frames to draw among `count` with the numbers from `first`: the selected ones that are not up to date.
void choose_frames(Pictures& p, long first, long count);
// Adds the times to the requests for the motions.
void put_times(Pictures& p, FilmTimes times);
// Poses per second of a page between two times [s]: `fps`, or more for a short motion.
FrameRate rate_of_page(FrameRate fps, double from, double to);

// Sets the studies and the maker of the figure. `how` contains times, no events.
void prepare_figure(FigureFile& figure, const Scene& scene, const FigureOutput& how);
// Replaces the events in `how` by their times in `motion`. `end_time`: of the scene [s]. Throws render::PictureError
// for events that do not occur, or occur in the wrong order.
FigureOutput with_event_times(FigureOutput how, const sim::Result& motion, double end_time);
// The same; `find` first searches the motion whose events count: the first compared motion, else the scene's.
FigureOutput with_found_times(const FigureOutput& how, const Scene& scene, const FindEvents& find);
// Replaces events by the start and the end of the scene: the largest interval that the figure can show.
FigureOutput without_events(FigureOutput how);

}  // namespace beamcam::scenes
