// The times of a picture's frames and of its charts and traces: k/fps in real time, or through the TimeMap of slow
// motion and freezes, which may depend on events.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/film/film.hpp"
#include "scenes/scene/scene.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

struct FilmTimes {
    std::vector<double> frames;  // [s] of the motion, not decreasing
    long first = 0;              // number of the first frame
    std::vector<double> speeds;  // of each frame; empty in real time
    std::vector<render::Callout> callouts;
    std::vector<render::CameraMove> moves;
    std::vector<std::string> unreached_events;  // events outside the film: "impact 3"
    std::optional<int> poster;                  // index into frames
    std::vector<double> chart, trace;           // rows [s], increasing
    // Equally spaced over the shown time, independent of the frames, for the choice of scales [s].
    std::vector<double> survey;
    std::vector<double> path;  // between frames that are far apart, for the path of the tip [s], increasing
};

// Why a span has no frames, or too many; empty if it is valid, as far as that is known before the motion.
std::string problem_with_span(const FrameSpan& span, double end_time);
std::string pauses_fill(const FrameSpan& span);  // that problem of a span with a duration
// Returns the span with times in place of events at its ends. Throws render::PictureError for an event that does not
// occur, and for a span without frames.
FrameSpan resolved(const FrameSpan& span, double end_time, const sim::Result& motion);

// The number of frames of a film of this length in film time. Throws render::PictureError if it has none or too many.
double frame_count(const FrameSpan& span, double seconds);
// In real time frame k shows k/fps: the numbers of the first one and of the end, which is not shown, are nearest to
// `from` and `to`.
std::pair<double, double> frames_between(double from, double to, double fps);

// `motion` contains the events until the end of the span if the span needs them; else it may be empty. `slowed`:
// impacts of all compared motions, for slow motion; "impact:3" counts those of `motion`. `collisions`: charts get more
// rows within collisions. Throws render::PictureError for an event that does not occur and for too many frames.
FilmTimes film_times(const FrameSpan& span, double end_time, const sim::Result& motion,
                     const std::vector<sim::Impact>& slowed, bool collisions = false);
// The instants of a page: those of `span`, and more within impacts, so that the force is known between them.
FilmTimes page_times(const FrameSpan& span, double end_time, const sim::Result& motion);
// `until`: end of the motion that determines the scales [s]. `impacts`: charts get more rows within their collisions.
// `turn`: the time that a still of the beginning shows [s].
FilmTimes still_times(const Instant& at, const sim::Result& motion, double until,
                      const std::vector<sim::Impact>& impacts = {},
                      double turn = std::numeric_limits<double>::infinity());

// The camera's movements to the keyframes. Throws render::PictureError for an event that does not occur; `shortened`:
// such a keyframe is skipped.
void add_moves(FilmTimes& times, const View& view, double fps, const sim::Result& motion, bool shortened);

// The first of the frames at or after this time, else the last one.
int first_at(const std::vector<double>& frames, double t);

// The times k / rate between `from` and `to`, and `to` itself.
std::vector<double> rows(double from, double to, double rate);

constexpr double kMostFrames = 50'000;  // 14 minutes at 60 per second; their poses need 120 MB

}  // namespace beamcam::scenes
