#include "scenes/sweep/diagram.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scenes/figures/caption.hpp"
#include "scenes/figures/key_label.hpp"
#include "scenes/format/sweep_keys.hpp"
#include "scenes/scene/exit_code.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::scenes {
namespace {

namespace figure = render::figure;
using render::Color;
using render::rgb;
using sim::AttractorClass;

// One colour a class, and for periods from one to five; beyond these the last.
Color color_of(AttractorClass kind) {
    switch (kind) {
        case AttractorClass::rest:
            return rgb(0xF2F2F2);
        case AttractorClass::following:
            return rgb(0xD0D0D0);
        case AttractorClass::periodic:
            return rgb(0x0072B2);
        case AttractorClass::quasi_periodic:
            return rgb(0x009E73);
        case AttractorClass::chaotic:
            return rgb(0xD55E00);
        case AttractorClass::aperiodic:
            return rgb(0xE69F00);
        case AttractorClass::over_the_top:
            return rgb(0x404040);
        case AttractorClass::unsettled:
            return rgb(0xF0E442);
    }
    return {};
}
constexpr std::uint32_t kPeriodColors[] = {0x08306B, 0x2171B5, 0x6BAED6, 0x9ECAE1, 0xC6DBEF};
constexpr std::uint32_t kValueColors[] = {0x000000, 0xD55E00, 0x0072B2, 0x009E73, 0xCC79A7, 0xE69F00};
constexpr std::uint32_t kSeedColors[] = {0x000000, 0xE0218A, 0x009E73, 0x56B4E9};

AttractorClass kind_of(const output::StoredPoint& p) { return static_cast<AttractorClass>(p.kind); }

// Only these have samples that mean a section of their attractor.
bool is_section(AttractorClass kind) {
    return kind == AttractorClass::periodic || kind == AttractorClass::quasi_periodic ||
           kind == AttractorClass::chaotic || kind == AttractorClass::aperiodic;
}

std::string label_of(const std::string& name, const std::string& unit) {
    return name == "cam_phase" ? "cam phase / turn" : axis_label(symbol_of(name), unit);
}
std::string axis_label(const output::SweepAxis& axis) { return label_of(axis.name, axis.unit); }

std::string seed_label(const SweepGrid& grid, std::uint64_t seed) {
    switch (grid.seed(seed)) {
        case SeedKind::same:
            return "same start";
        case SeedKind::carry_up:
            return "carried up";
        case SeedKind::carry_down:
            return "carried down";
        case SeedKind::random:
            break;
    }
    return "random starts";
}

// Beside the strip of classes, whose highest lane is the first start.
std::string lane_label(SeedKind kind) {
    switch (kind) {
        case SeedKind::same:
            return "= ";
        case SeedKind::carry_up:
            return "→ ";
        case SeedKind::carry_down:
            return "← ";
        case SeedKind::random:
            break;
    }
    return "";
}

std::size_t column_of(const output::SweepData& data, const std::string& name) {
    std::vector<std::string> known;
    for (std::size_t c = 0; c < data.columns.size(); ++c) {
        if (data.columns[c].name == name) return c;
        known.push_back(data.columns[c].name);
    }
    throw SceneError(fmt::format("the samples have no column {}: {}", name, fmt::join(known, ", ")));
}

// Edges of cells around the values, half-way between neighbours.
std::vector<double> edges_around(std::vector<double> values) {
    std::ranges::sort(values);
    if (values.size() == 1) return {values[0] - 0.5, values[0] + 0.5};
    std::vector<double> edges{values[0] - 0.5 * (values[1] - values[0])};
    for (std::size_t i = 1; i < values.size(); ++i) edges.push_back(0.5 * (values[i - 1] + values[i]));
    edges.push_back(values.back() + 0.5 * (values.back() - values[values.size() - 2]));
    return edges;
}
// By index the place of each value in ascending order.
std::vector<std::size_t> ranks(const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size()), rank(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
    for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
    return rank;
}

figure::Scale scale_of(const SweepGrid& grid, std::size_t axis) {
    return grid.sweep().over[axis].logarithmic ? figure::Scale::logarithmic : figure::Scale::linear;
}

// What is known of the points, for the caption.
std::string caption(const SweepGrid& grid, const output::SweepData& data) {
    std::map<int, std::uint64_t> kinds;
    for (std::uint64_t k = 0; k < data.points(); ++k)
        if (data.has(k)) ++kinds[data.read(k).kind];
    const sim::Sampling& s = grid.sampling();
    const auto span = [](const sim::CamSpan& c) {
        return c.time ? fmt::format("{:g} s", *c.time) : fmt::format("{:g} turns of the cam", c.turns);
    };
    std::string text;
    for (const output::SweepAxis& axis : grid.axes())
        text += fmt::format("{} = {:.6g} … {:.6g}{} in {} values; ", symbol_of(axis.name),
                            *std::ranges::min_element(axis.values), *std::ranges::max_element(axis.values),
                            axis.unit == "1" ? "" : " " + axis.unit, axis.values.size());
    text += fmt::format("samples: {}; transient {}, then {} kept; starts: ", text_of_sample(s), span(s.transient),
                        span(s.keep));
    std::string seeds;
    for (std::uint64_t k = 0; k < std::min<std::uint64_t>(grid.seeds(), 3); ++k) {
        const std::string label = seed_label(grid, k);
        if (k == 0 || label != seed_label(grid, k - 1)) seeds += (k > 0 ? ", " : "") + label;
    }
    text += seeds + (grid.seeds() > 3 ? fmt::format(" ({})", grid.seeds()) : "") + ". Points: ";
    std::string counts;
    for (const auto& [kind, count] : kinds)
        counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, name(static_cast<AttractorClass>(kind)));
    text += counts + ". ";
    if (kinds.contains(static_cast<int>(AttractorClass::chaotic)))
        text += "Where the motion is chaotic a point is a statistic of its start, transient and periods. ";
    Varied varied;
    varied.cam_speed =
        grid.axes()[0].name == "cam.speed" || (grid.axes().size() > 1 && grid.axes()[1].name == "cam.speed");
    return text + "But for what is swept: " + facts(grid.scene().problem, Lang::en, varied);
}

std::string accuracy(const SweepGrid& grid) {
    return fmt::format("Relative tolerance {} (a rigid beam with impulsive contact: rounding).",
                       one_digit(grid.scene().problem.solver.rtol));
}

void add_swatches(figure::Panel& panel, const std::map<int, bool>& shown) {
    for (const auto& [kind, any] : shown)
        if (any)
            panel.swatches.push_back(
                {name(static_cast<AttractorClass>(kind)), color_of(static_cast<AttractorClass>(kind))});
}

// Which class stands where: a row of cells for each start.
figure::Panel class_strip(const SweepGrid& grid, const output::SweepData& data) {
    figure::Panel strip;
    strip.name = "class";
    const std::vector<double>& values = grid.axes()[0].values;
    const std::vector<std::size_t> rank = ranks(values);
    const std::uint64_t lanes = std::min<std::uint64_t>(grid.seeds(), 8);
    figure::Cells cells;
    cells.x = edges_around(values);
    for (std::uint64_t lane = 0; lane <= lanes; ++lane) cells.y.push_back(static_cast<double>(lane));
    cells.colors.assign(values.size() * lanes, Color{0, 0, 0, 0});
    std::map<int, bool> shown;
    for (std::uint64_t k = 0; k < data.points(); ++k) {
        const std::uint64_t seed = k % grid.seeds();
        if (!data.has(k) || seed >= lanes) continue;
        const output::StoredPoint p = data.read(k);
        // The first start stands highest.
        cells.colors[(lanes - 1 - seed) * values.size() + rank[k / grid.seeds()]] = color_of(kind_of(p));
        shown[p.kind] = true;
    }
    strip.cells.push_back(std::move(cells));
    add_swatches(strip, shown);
    strip.x = {.label = axis_label(grid.axes()[0]), .scale = scale_of(grid, 0), .tight = true};
    strip.y = {.label = {}, .from = 0, .to = static_cast<double>(lanes), .numbered = false, .ticked = false};
    for (std::uint64_t lane = lanes; lanes > 1 && lane-- > 0;) strip.y.label += lane_label(grid.seed(lane));
    strip.legend = figure::Legend::box;
    strip.share = 0.16;
    return strip;
}

figure::Figure bifurcation(const SweepGrid& grid, const output::SweepData& data, const std::string& ordinate) {
    const std::size_t column = column_of(data, ordinate), width = data.columns.size();
    figure::Panel panel;
    panel.name = ordinate;
    const bool random = grid.seed(0) == SeedKind::random;
    const std::uint64_t clouds = random ? 1 : grid.seeds();
    for (std::uint64_t seed = 0; seed < clouds; ++seed)
        panel.clouds.push_back(
            {clouds > 1 ? seed_label(grid, seed) : "",
             {},
             {},
             clouds > 1 ? rgb(kSeedColors[seed % std::size(kSeedColors)]).faded(seed > 0 ? 0.65 : 1) : rgb(0x000000)});
    for (std::uint64_t k = 0; k < data.points(); ++k) {
        if (!data.has(k)) continue;
        const output::StoredPoint p = data.read(k);
        if (!is_section(kind_of(p))) continue;
        figure::Cloud& cloud = panel.clouds[random ? 0 : k % grid.seeds()];
        for (std::size_t i = column; i < p.samples.size(); i += width) {
            cloud.x.push_back(data.place(k)[0]);
            cloud.y.push_back(p.samples[i]);
        }
    }
    figure::Figure out;
    figure::Panel strip = class_strip(grid, data);
    panel.x = {.label = axis_label(grid.axes()[0]),
               .scale = scale_of(grid, 0),
               .from = strip.cells[0].x.front(),
               .to = strip.cells[0].x.back(),
               .tight = true};
    strip.x.from = panel.x.from;
    strip.x.to = panel.x.to;
    panel.y = {.label = label_of(ordinate, data.columns[column].unit)};
    if (std::ranges::all_of(panel.clouds, [](const auto& c) { return c.x.empty(); })) panel.y.from = 0, panel.y.to = 1;
    panel.legend = figure::Legend::box;
    out.panels = {std::move(panel), std::move(strip)};
    out.stack = out.share_x = true;
    out.aspect = 0.8;
    return out;
}

// What stands in a cell of a map: periods apart from each other, other motions by their class.
struct MapEntry {
    std::string label;
    Color color;
};
MapEntry map_entry(const output::StoredPoint& p) {
    if (kind_of(p) != AttractorClass::periodic) return {name(kind_of(p)), color_of(kind_of(p))};
    const int shown = std::min<int>(p.period, std::size(kPeriodColors));
    return {fmt::format("period {}{}", shown, shown == std::size(kPeriodColors) ? " and more" : ""),
            rgb(kPeriodColors[shown - 1])};
}

figure::Figure map(const SweepGrid& grid, const output::SweepData& data) {
    if (grid.axes().size() != 2) throw SceneError("a map needs two keys that vary; give --over twice");
    figure::Panel panel;
    panel.name = "class";
    const output::SweepAxis &across = grid.axes()[0], &up = grid.axes()[1];
    const std::vector<std::size_t> column = ranks(across.values), row = ranks(up.values);
    figure::Cells cells{edges_around(across.values), edges_around(up.values), {}};
    cells.colors.assign(across.values.size() * up.values.size(), Color{0, 0, 0, 0});
    std::map<std::string, Color> entries;
    for (std::uint64_t k = 0; k < data.points(); k += grid.seeds()) {  // the first start
        if (!data.has(k)) continue;
        const std::uint64_t cell = k / grid.seeds(), width = across.values.size();
        const MapEntry entry = map_entry(data.read(k));
        cells.colors[row[cell / width] * width + column[cell % width]] = entry.color;
        entries.emplace(entry.label, entry.color);
    }
    for (const auto& [label, color] : entries) panel.swatches.push_back({label, color});
    panel.x = {.label = axis_label(across), .scale = scale_of(grid, 0), .tight = true};
    panel.y = {.label = axis_label(up), .scale = scale_of(grid, 1), .tight = true};
    panel.cells.push_back(std::move(cells));
    panel.legend = figure::Legend::box;
    figure::Figure out;
    out.panels = {std::move(panel)};
    out.aspect = 0.9;
    return out;
}

// A cloud for each value of one key, if they are few; else one of all.
std::vector<figure::Cloud> clouds_of(const SweepGrid& grid) {
    const output::SweepAxis& axis = grid.axes()[0];
    if (grid.axes().size() > 1 || axis.values.size() > std::size(kValueColors)) return {{"", {}, {}, rgb(0x000000)}};
    std::vector<figure::Cloud> clouds;
    for (std::size_t i = 0; i < axis.values.size(); ++i)
        clouds.push_back({value_label(symbol_of(axis.name), axis.values[i], axis.unit), {}, {}, rgb(kValueColors[i])});
    if (clouds.size() == 1) clouds[0].label.clear();
    return clouds;
}

// All samples of all points in one plane.
figure::Figure plane(const SweepGrid& grid, const output::SweepData& data, const std::string& x, const std::string& y,
                     bool next) {
    const std::size_t cx = column_of(data, x), cy = column_of(data, y), width = data.columns.size();
    figure::Panel panel;
    panel.name = y;
    panel.clouds = clouds_of(grid);
    panel.legend = figure::Legend::box;
    for (std::uint64_t k = 0; k < data.points(); ++k) {
        if (!data.has(k)) continue;
        const output::StoredPoint p = data.read(k);
        if (!is_section(kind_of(p))) continue;
        figure::Cloud& cloud = panel.clouds[panel.clouds.size() > 1 ? k / grid.seeds() : 0];
        const std::size_t later = next ? width : 0;
        for (std::size_t i = 0; i + later < p.samples.size(); i += width) {
            cloud.x.push_back(p.samples[i + cx]);
            cloud.y.push_back(p.samples[i + later + cy]);
        }
    }
    if (std::ranges::all_of(panel.clouds, [](const auto& c) { return c.x.empty(); }))
        throw SceneError("no point has a section to show: all rest, follow the cam, have left it or have not settled");
    const std::string unit = data.columns[cy].unit;
    panel.x = {.label = label_of(x, data.columns[cx].unit) + (next ? ", impact $k$" : "")};
    panel.y = {.label = label_of(y, unit) + (next ? ", impact $k$ + 1" : "")};
    figure::Figure out;
    out.panels = {std::move(panel)};
    out.aspect = 0.9;
    return out;
}

}  // namespace

std::vector<std::string> diagram_names(const SweepGrid& grid) {
    const auto initial = [](const output::SweepAxis& axis) { return axis.name.starts_with("initial."); };
    if (grid.axes().size() == 2)
        return {std::ranges::all_of(grid.axes(), initial) ? "basins" : "map", "poincare", "impact-map"};
    return {"bifurcation", "poincare", "impact-map"};
}

const char* usual_ordinate(const SweepGrid& grid) {
    return grid.sampling().kind == sim::SampleKind::impacts ? "v_n_before" : "theta";
}

figure::Figure diagram(const std::string& name, const SweepGrid& grid, const output::SweepData& data,
                       const std::string& ordinate) {
    figure::Figure out;
    if (name == "bifurcation" && grid.axes().size() == 1)
        out = bifurcation(grid, data, ordinate);
    else if (name == "map" || name == "basins")
        out = map(grid, data);
    else if (name == "poincare")
        out = plane(grid, data, grid.sampling().kind == sim::SampleKind::impacts ? "cam_phase" : "theta",
                    grid.sampling().kind == sim::SampleKind::impacts ? "v_n_before" : "theta_dot", false);
    else if (name == "impact-map")
        out = plane(grid, data, "cam_phase", "cam_phase", true);
    else
        throw SceneError(fmt::format("this sweep has no figure {}: {}", name, fmt::join(diagram_names(grid), ", ")));
    out.name = name;
    out.title = fmt::format("{} over {}", name, grid.axes()[0].name);
    out.caption = caption(grid, data);
    out.accuracy = accuracy(grid);
    return out;
}

}  // namespace beamcam::scenes
