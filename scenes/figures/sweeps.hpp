// Figures of a scene's sweep: the bifurcation diagram of one parameter, the map of two, Poincaré sections and impact
// maps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
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

// The fewest decimals that distinguish values, the same for all, so that texts do not jump between "44.9667" and "45".
// None for values too large or too close for plain decimals.
std::optional<int> decimals_of(std::vector<double> values);
// How values are written that are shown one after the other: with decimals, else with significant digits.
struct ValueDigits {
    std::optional<int> decimals;
    int significant = 3;
};
// The fewest that distinguish the values of a linear axis by decimals, of a logarithmic one by significant digits, in
// the unit of a GrowingDiagram's axis; `shown` in SI units.
ValueDigits value_digits(const Swept& swept, std::vector<double> shown, Lang lang);
// "$ω$ = 45.2 rad/s: period 2 turns, 3 impacts", with symbol and unit of a GrowingDiagram's axis, for
// render/plot/user_text.hpp.
std::string point_text(const Swept& swept, std::uint64_t point, const ValueDigits& digits, Lang lang);

// The bifurcation diagram of a film, of which each frame shows more points.
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
    double factor_ = 1;                                          // from the key's SI unit to that of the axis
};

}  // namespace beamcam::scenes
