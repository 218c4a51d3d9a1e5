// Where a curve of a motion can be relied on: it is drawn lighter within the intervals in which θ is not reproducible.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "render/plot/figure.hpp"
#include "scenes/figures/caption.hpp"

namespace beamcam::scenes {

// Within it θ is not reproducible [s].
struct Lost {
    double from, to;
    bool holds(double t) const { return t > from && t <= to; }
};
// Of a study with a horizon, until `end`.
std::vector<Lost> unreliable(const sim::Result& result, double end);

// The curve outside of the intervals, and within them; neighbouring pieces share a point. `times`: of its points.
std::array<render::figure::Series, 2> split(const render::figure::Series& whole, const std::vector<double>& times,
                                            const std::vector<Lost>& intervals);

// Where θ is not reproducible, if anywhere: of motions by their names, of one by none.
std::string horizon_words(const std::vector<std::pair<std::string, const sim::Result*>>& motions, double from,
                          double end, Lang lang);

}  // namespace beamcam::scenes
