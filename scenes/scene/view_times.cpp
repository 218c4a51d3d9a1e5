// The camera's movements in a film.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/base/error.hpp"
#include "scenes/scene/film_times.hpp"
#include "scenes/scene/time_map.hpp"

namespace beamcam::scenes {

// The frame number of a time; before and after the film at real time.
static double frame_at(const std::vector<double>& frames, double t, double fps) {
    const auto last = static_cast<double>(frames.size() - 1);
    if (t < frames.front()) return (t - frames.front()) * fps;
    if (t > frames.back()) return last + (t - frames.back()) * fps;
    return first_at(frames, t);
}

void add_moves(FilmTimes& times, const View& view, double fps, const sim::Result& motion, bool shortened) {
    std::vector<std::pair<double, const Keyframe*>> keys;  // and their frames
    std::optional<double> latest;
    for (const Keyframe& key : view.keyframes) {
        const auto t = shortened ? find_instant(key.at, motion) : instant_of(key.at, motion);
        if (!t) {
            times.unreached_events.push_back("the camera at " + name_of(key.at));
            continue;
        }
        if (latest && *t <= *latest)
            throw render::PictureError(
                fmt::format("the camera's keyframe at {}, {:g} s, is not after the previous one, {:g} s; list the "
                            "keyframes in order of time",
                            name_of(key.at), *t, *latest));
        latest = t;
        keys.emplace_back(frame_at(times.frames, *t, fps), &key);
    }
    render::Shot shot = view.shot;
    double before = 0;
    for (const auto& [frame, key] : keys) {
        shot = {key->zoom.value_or(shot.zoom), key->follow.value_or(shot.follow), key->yaw.value_or(shot.yaw),
                key->pitch.value_or(shot.pitch)};
        const double since = std::max(0.0, frame - before);
        times.moves.push_back({frame, key->over ? *key->over * fps : since, key->ease, shot});
        before = frame;
    }
}

}  // namespace beamcam::scenes
