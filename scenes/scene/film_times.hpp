// The instants of a picture's frames, and of the charts and traces beside them: k/fps in real time, or through the
// TimeMap of slow motion and freezes, which may have to know the impacts first.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/film/film.hpp"
#include "scenes/scene/scene.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

struct FilmTimes {
    std::vector<double> frames;     // [s] of the motion, not decreasing
    std::vector<double> exposures;  // of each frame in turn, its own instant first; empty: that alone
    long first = 0;                 // number of the first frame
    std::vector<double> speeds;     // of each frame; empty in real time
    std::vector<render::Callout> callouts;
    std::vector<render::CameraMove> moves;
    std::vector<std::string> unreached_events;  // events that the film does not reach or begins after: "impact 3"
    std::optional<int> poster;                  // index into frames
    std::vector<double> chart, trace;           // rows [s], increasing
    // Evenly over the time that is shown, whatever the frames: what scales are chosen by [s].
    std::vector<double> survey;
};

// `motion` has the impacts and collisions until the span's end where the span looks at them; else it may be empty.
// Throws render::PictureError for an impact that the whole motion does not have and for a film of too many frames.
// `collisions`: the charts get more rows within each of the motion's.
FilmTimes film_times(const FrameSpan& span, double end_time, const sim::Result& motion, bool collisions = false);
// `slowed`: the impacts that time slows around, of all the motions that a picture compares; "impact:3" is `motion`'s.
FilmTimes film_times(const FrameSpan& asked, double end_time, const sim::Result& motion,
                     const std::vector<sim::Impact>& slowed, bool collisions = false);
// `until`: how far the motion goes that gives the still its scales [s].
FilmTimes still_times(const Instant& at, const sim::Result& motion, double until, bool collisions = false);

// The moves to a view's keyframes. Throws render::PictureError for an impact that the whole motion does not have;
// `shortened`: one that it does not have is left out.
void add_moves(FilmTimes& times, const View& view, double fps, const sim::Result& motion, bool shortened);

// The instants of a view's shutter or strobe; none is before 0 or after `end`.
void add_exposures(FilmTimes& times, const View& view, double fps, double end);

// k / rate from `from`, and `to` itself.
std::vector<double> rows(double from, double to, double rate);

constexpr double kMostFrames = 250'000;  // over an hour at 60 fps; their poses fill 0.6 GB of disk

}  // namespace beamcam::scenes
