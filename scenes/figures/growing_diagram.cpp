#include "scenes/figures/growing_diagram.hpp"

#include <algorithm>

#include "scenes/figures/bifurcation_diagram.hpp"
#include "scenes/figures/recipes.hpp"

namespace beamcam::scenes {

GrowingDiagram::GrowingDiagram(const Swept& swept, const FigureOutput& how, const std::vector<std::size_t>& place) {
    const SweptPoints points(swept, how.lang);
    std::vector<std::uint64_t> order = as_numbered(points);
    std::ranges::stable_sort(order, {}, [&](std::uint64_t k) { return place[k]; });
    places_.resize(2);
    whole_ = bifurcation(points, how.value, order, [&](std::size_t panel, std::size_t cloud, std::uint64_t point) {
        std::vector<std::vector<std::size_t>>& of_panel = places_[panel];
        of_panel.resize(std::max(of_panel.size(), cloud + 1));
        of_panel[cloud].push_back(place[point]);
    });
    if (whole_.panels.size() < 3) places_.pop_back();  // no exponent is known
    for (std::size_t i = 0; i < places_.size(); ++i) places_[i].resize(whole_.panels[i].clouds.size());
    whole_.panels.front().legend = render::figure::Legend::above;  // a place in the plot would change as it fills
    const std::vector<std::optional<std::size_t>> cells = strip_cells(points);
    cells_.assign(whole_.panels.back().cells[0].colors.size(), 0);
    for (std::size_t k = 0; k < cells.size(); ++k)
        if (cells[k]) cells_[*cells[k]] = place[k];
    whole_.name = kBifurcation.name;
}

render::figure::Figure GrowingDiagram::until(std::size_t last, double at) const {
    render::figure::Figure out = whole_;
    for (std::size_t i = 0; i < places_.size(); ++i) {
        for (std::size_t c = 0; c < places_[i].size(); ++c) {
            const std::vector<std::size_t>& places = places_[i][c];
            out.panels[i].clouds[c].shown =
                static_cast<std::size_t>(std::ranges::upper_bound(places, last) - places.begin());
        }
        out.panels[i].rules.push_back({.at = at, .vertical = true});
    }
    std::vector<render::Color>& colors = out.panels.back().cells[0].colors;
    for (std::size_t i = 0; i < colors.size(); ++i)
        if (cells_[i] > last) colors[i] = render::Color{0, 0, 0, 0};
    return out;
}

}  // namespace beamcam::scenes
