// Figures of a scene's sweep: the bifurcation diagram of one parameter, the map of two, Poincaré sections and impact
// maps.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/plot/figure.hpp"
#include "scenes/figures/studies.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

std::vector<std::string> diagram_names();
// The one that suits the scene's sweep.
std::string usual_diagram(const Scene& scene);

// The bifurcation diagram as it grows.
class GrowingDiagram {
  public:
    // `place`: of each point in the order in which they come. The sweep outlives this. Throws PictureError for a value
    // that the samples have not.
    GrowingDiagram(const Swept& swept, const FigureOutput& how, const std::vector<std::size_t>& place);
    // The points up to this place, and a line at a value of the key.
    render::figure::Figure until(std::size_t last, double at) const;

  private:
    render::figure::Figure whole_;
    std::vector<std::vector<std::vector<std::size_t>>> places_;  // of what each cloud of each panel shows, ascending
    std::vector<std::size_t> cells_;                             // of the last panel's
};

// "ω = 45.2 rad/s: period 2, 3 impacts"; plain.
std::string words_of_point(const Swept& swept, std::uint64_t point, Lang lang);

}  // namespace beamcam::scenes
