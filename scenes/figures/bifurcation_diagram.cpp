#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "scenes/figures/figure_types.hpp"
#include "scenes/figures/sweeps.hpp"
#include "scenes/figures/swept_points.hpp"

namespace beamcam::scenes {

namespace figure = render::figure;
using render::Color;
using render::rgb;
using sim::AttractorClass;

namespace {

constexpr std::uint32_t kSeedColors[] = {0x000000, 0xE0218A, 0x009E73, 0x56B4E9};
constexpr double kOverFirst = 0.65;  // opacity of the other starts' dots, which do not hide those of the first

constexpr std::uint64_t kMostLanes = 8;
std::uint64_t lanes_of(const SweptPoints& points) { return std::min(points.seeds(), kMostLanes); }

// The cell of each point in the strip of classes; none beyond the lanes, of which the first start's is the highest.
std::vector<std::optional<std::size_t>> strip_cells(const SweptPoints& points) {
    const std::vector<std::size_t> rank = ranks(points.axis(0).values);
    std::vector<std::optional<std::size_t>> cells(points.data.points());
    for (std::uint64_t k = 0; k < cells.size(); ++k)
        if (const std::uint64_t seed = k % points.seeds(); seed < lanes_of(points))
            cells[k] = (lanes_of(points) - 1 - seed) * rank.size() + rank[k / points.seeds()];
    return cells;
}

// The classes of the motions: a row of cells for each start.
figure::Panel class_strip(const SweptPoints& points) {
    const std::vector<double>& values = points.axis(0).values;
    const std::vector<std::optional<std::size_t>> cell = strip_cells(points);
    const std::uint64_t lanes = lanes_of(points);
    figure::Cells cells;
    cells.x = edges_around(values, points.scale(0));
    for (std::uint64_t lane = 0; lane <= lanes; ++lane) cells.y.push_back(static_cast<double>(lane));
    cells.colors.assign(values.size() * lanes, Color{0, 0, 0, 0});
    std::map<AttractorClass, bool> shown;
    for (std::uint64_t k = 0; k < points.data.points(); ++k) {
        if (!points.data.has(k) || !cell[k]) continue;
        const AttractorClass kind = kind_of(points.data.read(k));
        cells.colors[*cell[k]] = color_of(kind);
        shown[kind] = true;
    }
    figure::Panel strip{.y = {.from = 0, .to = static_cast<double>(lanes), .numbered = false, .ticked = false},
                        .cells = {std::move(cells)},
                        .share = 0.16,
                        .name = "class"};
    for (const auto& [kind, any] : shown) strip.swatches.push_back({class_label(kind, points.lang), color_of(kind)});
    for (std::uint64_t lane = lanes; lanes > 1 && lane-- > 0;) strip.y.label += look_of(points.seed(lane)).lane;
    return strip;
}

// A cloud for each start that is distinguished.
std::vector<figure::Cloud> clouds_of_starts(const SweptPoints& points) {
    const std::uint64_t count = points.seed(0) == SeedKind::random ? 1 : points.seeds();
    std::vector<figure::Cloud> clouds;
    for (std::uint64_t seed = 0; seed < count; ++seed)
        clouds.push_back({count > 1 ? phrase(points.lang, look_of(points.seed(seed)).label) : "",
                          {},
                          {},
                          count > 1 ? rgb(kSeedColors[seed % std::size(kSeedColors)]).faded(seed > 0 ? kOverFirst : 1)
                                    : rgb(0x000000)});
    return clouds;
}

// Samples and exponents as clouds, one for each start that is distinguished.
struct Dots {
    std::vector<figure::Cloud> samples, exponents;
    bool merging = false;  // an exponent is −∞
};
Dots dots_of(const SweptPoints& points, std::size_t column) {
    const std::size_t width = points.data.columns.size();
    Dots out{clouds_of_starts(points), clouds_of_starts(points)};
    for (std::uint64_t k = 0; k < points.data.points(); ++k) {
        if (!points.data.has(k)) continue;
        const output::StoredPoint p = points.data.read(k);
        const std::size_t cloud = out.samples.size() > 1 ? k % points.seeds() : 0;
        const double at = points.value(k);
        if (std::isfinite(p.exponent)) out.exponents[cloud].add(at, p.exponent);
        out.merging = out.merging || std::isinf(p.exponent);
        if (!has_section(kind_of(p))) continue;
        for (std::size_t i = column; i < p.samples.size(); i += width)
            out.samples[cloud].add(at, drawn(points, column, p.samples[i]));
    }
    return out;
}

figure::Panel exponents_panel(std::vector<figure::Cloud> clouds) {
    constexpr double kMargin = 0.1;  // of the range: in this low panel the usual margin is narrower than a dot
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const figure::Cloud& cloud : clouds)
        for (const double exponent : cloud.y) low = std::min(low, exponent), high = std::max(high, exponent);
    figure::Panel panel{.y = {.label = "$λ_1$ / s^{−1}"},
                        .clouds = std::move(clouds),
                        .rules = {{.at = 0}},
                        .legend = false,
                        .share = 0.35,
                        .name = "exponent"};
    const double margin = kMargin * (high - low);
    if (margin > 0) panel.y.from = low - margin, panel.y.to = high + margin;
    return panel;
}

// A cloud without points, which names the colour of dots of all starts at one place.
figure::Cloud coinciding(const std::vector<figure::Cloud>& clouds, Lang lang) {
    Color all = clouds.front().color;
    for (const figure::Cloud& cloud : clouds) all = mix(all, cloud.color, cloud.color.a);
    all.a = 1;
    return {.label = phrase(lang, "coinciding"), .color = all};
}

// `classes`: those of the motions.
figure::Panel samples_panel(const SweptPoints& points, std::size_t column, std::vector<figure::Cloud> clouds,
                            const std::vector<figure::Swatch>& classes) {
    figure::Panel panel{.y = {.label = column_label(points, column)},
                        .clouds = std::move(clouds),
                        .name = points.data.columns[column].name};
    if (!all_empty(panel.clouds)) {
        if (panel.clouds.size() > 1) panel.clouds.push_back(coinciding(panel.clouds, points.lang));
        return panel;
    }
    std::vector<std::string> names;
    for (const figure::Swatch& each : classes) names.push_back(each.label);
    panel.title = phrase(points.lang, "No samples to draw; motions: {}", fmt::format("{}", fmt::join(names, ", ")));
    panel.y = {.from = 0, .to = 1, .numbered = false, .ticked = false};  // numbers would be invented
    panel.legend = false;
    panel.share = 0.15;
    return panel;
}

std::string usual_value(const SweptPoints& points) {
    if (points.scene.sweep->sampling.kind == sim::SampleKind::peaks) return "force_peak";
    return points.of_impacts() ? "v_n_before" : "theta";
}

}  // namespace

figure::Figure bifurcation(const SweptPoints& points, const FigureOutput& how) {
    const std::size_t column = points.column(how.value.empty() ? usual_value(points) : how.value);
    Dots dots = dots_of(points, column);
    const bool empty = all_empty(dots.samples), known = !all_empty(dots.exponents);
    figure::Figure out;
    figure::Panel strip = class_strip(points);
    out.panels = {samples_panel(points, column, std::move(dots.samples), strip.swatches)};
    if (known) out.panels.push_back(exponents_panel(std::move(dots.exponents)));
    if (known && dots.merging) out.panels.back().title = phrase(points.lang, "$λ_1$ without a mark: −∞ or unknown");
    out.panels.push_back(std::move(strip));
    const std::vector<double> edges = out.panels.back().cells[0].x;
    for (figure::Panel& each : out.panels)
        each.x = {.label = label_of(points.axis(0)),
                  .scale = points.scale(0),
                  .from = edges.front(),
                  .to = edges.back(),
                  .tight = true};
    out.stack = out.share_x = true;
    out.aspect = empty ? 0.45 : known ? 1.05 : 0.8;
    return out;
}

}  // namespace beamcam::scenes
