// A key of a scene and a range of its values, as an argument of a command.
#pragma once

#include <string>

#include "render/film/film.hpp"
#include "sim/problem/number_keys.hpp"

namespace beamcam::scenes {

// "cam.speed=40:60"
struct KeyRange {
    sim::NumberKey key;
    double from = 0, to = 0;
};

// The range of `--over`, whose unit diagrams take over. Throws UsageError, SceneError.
KeyRange range_argument(const std::string& over, const sim::Problem& problem, render::Units& units);

}  // namespace beamcam::scenes
