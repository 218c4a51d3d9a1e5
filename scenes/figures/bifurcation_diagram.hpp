// The bifurcation diagram: samples over one parameter, the largest exponent where it is known, and a strip with the
// class of each motion. A film shows it point by point.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenes/figures/swept_points.hpp"

namespace beamcam::scenes {

// `value`: a column of the samples; empty: the default one. Throws PictureError for a column that they do not have.
render::figure::Figure bifurcation(const SweptPoints& points, const std::string& value);

// The diagram of a film, of which each frame shows more points.
class GrowingDiagram {
  public:
    // `place`: of each point in the order in which the film shows them. The sweep must outlive this. Throws
    // PictureError like `bifurcation`.
    GrowingDiagram(const Swept& swept, const FigureOutput& how, const std::vector<std::size_t>& place);
    // The points up to this place, and a line at a value of the key.
    render::figure::Figure until(std::size_t last, double at) const;

  private:
    render::figure::Figure whole_;
    std::vector<std::vector<std::vector<std::size_t>>> places_;  // of the points of each cloud of each panel, ascending
    std::vector<std::size_t> cells_;                             // of the last panel's cells
};

}  // namespace beamcam::scenes
