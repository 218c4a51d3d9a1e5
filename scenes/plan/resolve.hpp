// Replaces the events in the keys of outputs by times: the step between reading a scene and planning it. Only outputs
// that name events, or slow down around impacts, need a run of the motion here, which ends as soon as they are found.
#pragma once

#include <cstddef>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "scenes/scene/film_times.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// An output with times in place of events.
struct ResolvedOutput {
    std::size_t index = 0;  // into the scene's outputs
    Output output;          // of pictures: as in the scene, except for the rate of a page
    double end_time = 0;    // of pictures: the last time that they need [s]
    FilmTimes times = {};   // of pictures
};
struct ResolvedScene {
    const Scene& scene;
    std::vector<ResolvedOutput> outputs;
};

// Integrates the problem until the request is answered.
using FindEvents = std::function<sim::Result(const sim::Problem& problem, const sim::Request& request)>;
// Does the work of one output. If it handles the failure, such as that of events that do not occur, the output is left
// out.
using AttemptOutput = std::function<void(std::size_t output, const std::function<void()>& work)>;
inline void attempt_or_throw(std::size_t, const std::function<void()>& work) { work(); }

// `without`: indices of outputs to leave out. The scene must outlive the result.
ResolvedScene resolve(const Scene& scene, const std::set<std::size_t>& without, const FindEvents& find,
                      const AttemptOutput& attempt = attempt_or_throw);
ResolvedScene resolve(const Scene& scene, const FindEvents& find);  // all outputs

// True if the times of the output depend on events.
bool needs_events(const Output& output, const Scene& scene);
// The end of a run that finds all events that the output may depend on [s].
double events_until(const Output& output, const Scene& scene);

// The panels of charts in a picture that ends at `end_time` [s].
std::vector<render::PanelSpec> panels_of(const PictureOutput& p, const Scene& scene, double end_time);
// True for slow motion, and for a still of an event or of several motions: the standard layout shows the latest
// collision.
bool shows_latest_collision(const PictureOutput& p, double end_time);
// The figure with times in place of events; `find` searches the first compared motion, else the scene's.
FigureOutput resolved(const FigureOutput& how, const Scene& scene, const FindEvents& find);

}  // namespace beamcam::scenes
