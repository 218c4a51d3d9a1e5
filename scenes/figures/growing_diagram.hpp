// The bifurcation diagram as it grows in a film: the whole one, of which more and more is shown.
#pragma once

#include <cstddef>
#include <vector>

#include "render/plot/figure.hpp"
#include "scenes/figures/studies.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

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

}  // namespace beamcam::scenes
