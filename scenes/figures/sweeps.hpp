// Figures of a scene's sweep: the bifurcation diagram of one parameter, the map of two, Poincaré sections and impact
// maps.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/plot/figure.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// Draws the scene's sweep as this type, which must live as long, and adds title, caption and accuracy.
FigureDrawing swept_figure(const FigureType& type, const FigureOutput& how);

std::vector<std::string> diagram_names();
// The default diagram of the scene's sweep.
std::string usual_diagram(const Scene& scene);
// The values of the key "value" for this diagram and the scene's sweep.
std::vector<std::string> diagram_values(std::string_view diagram, const Scene& scene);

}  // namespace beamcam::scenes
