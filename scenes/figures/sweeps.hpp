// Figures of a scene's sweep: the bifurcation diagram of one parameter, the map of two, Poincaré sections and impact
// maps.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/figures/studies.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

std::vector<std::string> diagram_names();
// The default diagram of the scene's sweep.
std::string usual_diagram(const Scene& scene);
// The values of the key "value" for this diagram and the scene's sweep.
std::vector<std::string> diagram_values(std::string_view diagram, const Scene& scene);

// "ω = 45.2 rad/s: period 2, 3 impacts", without markup. `decimals`: of the value; absent: six significant digits.
std::string point_text(const Swept& swept, std::uint64_t point, std::optional<int> decimals, Lang lang);

}  // namespace beamcam::scenes
