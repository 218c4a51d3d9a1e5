// The times of pictures. They are known from the keys, or after a first run if they depend on events.
#pragma once

#include "scenes/plan/plan.hpp"
#include "scenes/scene/film_times.hpp"

namespace beamcam::scenes {

// `motion` contains the events; it is empty for pictures whose times are known.
FilmTimes times_of(const Pictures& p, const sim::Result& motion);
// Chooses the frames to draw: the selected ones that are not up to date.
void choose_frames(Pictures& p, const FilmTimes& times);
// Adds the times to the requests for the motions; `request` is that of the scene's motion.
void put_times(Pictures& p, sim::Request& request, FilmTimes times);

// Poses per second of a page between two times [s]: `fps`, or more for a short motion.
FrameRate rate_of_page(FrameRate fps, double from, double to);

}  // namespace beamcam::scenes
