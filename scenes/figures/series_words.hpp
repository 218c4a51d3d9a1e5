// What the caption of a series says.
#pragma once

#include <string>
#include <vector>

#include "scenes/figures/caption.hpp"

namespace beamcam::scenes {

struct SeriesMotion {
    std::string label;
    sim::Problem problem;
    std::size_t study = 0;
};

// The channels that it shows, and against what.
std::string series_subject(const SeriesKeys& keys, Lang lang);
// "12 impacts", "no impact" until `end` [s].
std::string impacts_words(const sim::Problem& problem, const sim::Result& result, double end, Lang lang);
// The facts of all motions where they differ by the cam's speed alone, else those of the first.
std::string common_facts(const std::vector<SeriesMotion>& motions, Lang lang);

}  // namespace beamcam::scenes
