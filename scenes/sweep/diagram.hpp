// Figures of a sweep: the bifurcation diagram of one parameter, the map of two, Poincaré sections and impact maps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "output/data/sweep_data.hpp"
#include "render/plot/figure.hpp"
#include "scenes/sweep/sweep_grid.hpp"

namespace beamcam::scenes {

// "bifurcation", "map", "basins", "poincare", "impact-map". The one that suits the sweep comes first.
std::vector<std::string> diagram_names(const SweepGrid& grid);
// The column that a bifurcation diagram shows unless told another.
const char* usual_ordinate(const SweepGrid& grid);

// Throws SceneError where the sweep has no such figure or column.
render::figure::Figure diagram(const std::string& name, const SweepGrid& grid, const output::SweepData& data,
                               const std::string& ordinate);

}  // namespace beamcam::scenes
