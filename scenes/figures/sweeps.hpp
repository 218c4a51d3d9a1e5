// Figures of a scene's sweep: the bifurcation diagram of one parameter, the map of two, Poincaré sections and impact
// maps.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

std::vector<std::string> diagram_names();
// The one that suits the scene's sweep.
std::string usual_diagram(const Scene& scene);
// What the diagram can show of the points of the scene's sweep, by the key "value".
std::vector<std::string> diagram_values(std::string_view diagram, const Scene& scene);

}  // namespace beamcam::scenes
