// Measured or foreign data among the curves of a series.
#pragma once

#include <string>
#include <vector>

#include "render/plot/figure.hpp"
#include "scenes/figures/caption.hpp"
#include "scenes/figures/studies.hpp"

namespace beamcam::scenes {

// Data with the table that holds the motion at their instants.
struct Measured {
    Measurement data;
    std::size_t table = 0;
};

// The scene's data of these channels within [from, to]; adds the table that they are compared with.
std::vector<Measured> measured(const Scene& scene, const std::vector<sim::Channel>& channels, double from, double to,
                               std::size_t study, Studies& studies);

// Points, or a line if they are many. `x`, `y`: of the rows of the data, as drawn.
render::figure::Series measured_series(const Measurement& data, std::vector<double> x, std::vector<double> y, int look);

// "rig: 200 instants, root mean square difference of $θ$ 1.2×10^{−3} rad. "
std::string agreement_text(const std::vector<Measured>& all, const sim::Result& result, const sim::Problem& problem,
                           Lang lang);

}  // namespace beamcam::scenes
