// What goes with a film's pictures in time: subtitles of its impacts and captions, and chapters at its impacts.
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
// Impacts that follow each other within half a second of the film are told together.
FilmTrack film_track(const render::FilmSetup& film, Lang lang);

// As a file: WebVTT or SubRip.
std::string subtitle_file(const std::vector<Cue>& cues, Subtitles format);

}  // namespace beamcam::scenes
