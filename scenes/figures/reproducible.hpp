// The intervals in which θ of a motion is not reproducible. Curves are drawn lighter there.
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

// The curve outside of the intervals, and the curve within them; neighbouring pieces share a point. `times`: of its
// points.
std::array<render::figure::Series, 2> split(const render::figure::Series& whole, const std::vector<double>& times,
                                            const std::vector<Lost>& intervals);

// A sentence that names these intervals, by the names of the motions if there are several; empty: there are none.
std::string horizon_text(const std::vector<std::pair<std::string, const sim::Result*>>& motions, double from,
                         double end, Lang lang);

}  // namespace beamcam::scenes
