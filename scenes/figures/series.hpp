// Any channels against the time, the turns of the cam or another channel; of one motion or of several.
#pragma once

#include <string>

#include "scenes/figures/recipes.hpp"
#include "scenes/figures/series_plan.hpp"

namespace beamcam::scenes {

// What a figure by name says of the series that it is.
struct SeriesWords {
    const char* name = "series";
    std::string title, caption;        // empty: by the channels
    double aspect = 0;                 // 0: by the panels
    double weight = 0.9;               // of the lines
    std::vector<SeriesSum> sums = {};  // curves of the first panel, in place of its channels
    bool horizon = true;               // curves are paler where θ is not reproducible
    std::string (*caption_of)(const render::figure::Figure& figure, Lang lang) = nullptr;  // in place of `caption`
};

// `keys` has panels.
FigureMaker prepare_series(const Scene& scene, const SeriesKeys& keys, const SeriesWords& words, Lang lang,
                           Studies& studies);

}  // namespace beamcam::scenes
