// Subtitles of a film's impacts and texts, and chapters at its impacts.
#pragma once

#include <string>
#include <vector>

#include "output/film/video_library.hpp"
#include "render/film/film.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

struct Cue {
    double from = 0, to = 0;  // of the film [s]
    std::string text;         // plain
};
struct FilmTrack {
    std::vector<Cue> subtitles;
    std::vector<output::Chapter> chapters;  // none without impacts
};
// Impacts within 0.4 s of film time share one subtitle, and those that follow within 0.1 s.
FilmTrack film_track(const render::FilmSetup& film, Lang lang);

// The same texts one after the other, for a track of a film: texts at the same time are lines of one.
std::vector<output::Chapter> subtitle_track(const std::vector<Cue>& cues);

// The content of a WebVTT or SubRip file.
std::string subtitle_file(const std::vector<Cue>& cues, Subtitles format);

}  // namespace beamcam::scenes
