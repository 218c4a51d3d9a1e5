#include "scenes/figures/sample_plane.hpp"

#include "render/base/error.hpp"
#include "scenes/figures/key_label.hpp"

namespace beamcam::scenes {

namespace figure = render::figure;
using render::rgb;

namespace {

constexpr std::uint32_t kValueColors[] = {0x000000, 0xD55E00, 0x0072B2, 0x009E73, 0xCC79A7, 0xE69F00};

// A cloud for each value of one key, if they are few; else one of all.
std::vector<figure::Cloud> clouds_of_values(const SweptPoints& points) {
    const output::SweepAxis& axis = points.axis(0);
    if (points.data.axes.size() > 1 || axis.values.size() > std::size(kValueColors))
        return {{"", {}, {}, rgb(0x000000)}};
    std::vector<figure::Cloud> clouds;
    for (std::size_t i = 0; i < axis.values.size(); ++i)
        clouds.push_back({value_label(symbol_of(axis.name), axis.values[i], axis.unit), {}, {}, rgb(kValueColors[i])});
    if (clouds.size() == 1) clouds[0].label.clear();
    return clouds;
}

}  // namespace

figure::Figure sample_plane(const SweptPoints& points, const std::string& x, const std::string& y, bool next) {
    const std::size_t cx = points.column(x), cy = points.column(y), width = points.data.columns.size();
    figure::Panel panel;
    panel.name = y;
    panel.clouds = clouds_of_values(points);
    panel.legend = figure::Legend::box;
    for (std::uint64_t k = 0; k < points.data.points(); ++k) {
        if (!points.data.has(k)) continue;
        const output::StoredPoint p = points.data.read(k);
        if (!has_section(kind_of(p))) continue;
        figure::Cloud& cloud = panel.clouds[panel.clouds.size() > 1 ? k / points.seeds() : 0];
        const std::size_t later = next ? width : 0;
        for (std::size_t i = 0; i + later < p.samples.size(); i += width)
            add(cloud, drawn(points, cx, p.samples[i + cx]), drawn(points, cy, p.samples[i + later + cy]));
    }
    if (all_empty(panel.clouds))
        throw render::PictureError(
            "no point has a section to show: all rest, follow the cam, have left it or have not settled");
    const bool en = points.lang == Lang::en;
    const auto axis = [&](std::size_t c, const char* which, const char* zh) {
        return column_label(points, c) + (next ? en ? which : zh : "");
    };
    panel.x = {.label = axis(cx, ", impact $k$", "，第 $k$ 次碰撞")};
    panel.y = {.label = axis(cy, ", impact $k$ + 1", "，第 $k$ + 1 次碰撞")};
    figure::Figure out;
    out.panels = {std::move(panel)};
    out.aspect = 0.9;
    return out;
}

}  // namespace beamcam::scenes
