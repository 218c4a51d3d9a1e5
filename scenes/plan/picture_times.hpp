// The instants of a picture: at once where its keys say them, after a first look at the motion where impacts do.
#pragma once

#include "scenes/plan/plan.hpp"
#include "scenes/scene/film_times.hpp"

namespace beamcam::scenes {

// `motion`: where the impacts are; empty for pictures that are settled.
FilmTimes times_of(const Pictures& p, const sim::Result& motion);
// Chooses which of the frames are drawn: those asked for and not there yet.
void choose_frames(Pictures& p, const FilmTimes& times);
// Puts the instants where the motions are asked for them; `request` is that of the scene's own.
void put_times(Pictures& p, sim::Request& request, FilmTimes times);

// Of a page that goes from one instant to the other [s]: `fps`, or more where the motion is short.
FrameRate rate_of_page(FrameRate fps, double from, double to);

}  // namespace beamcam::scenes
