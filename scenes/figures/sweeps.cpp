#include "scenes/figures/sweeps.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "render/base/error.hpp"
#include "render/plot/ticks.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/figures/swept_points.hpp"
#include "sim/problem/number_keys.hpp"

namespace beamcam::scenes {
namespace {

namespace figure = render::figure;
using render::rgb;
using sim::AttractorClass;

// ---- captions -------------------------------------------------------------------------------------

bool has_random_starts(const SweptPoints& points) {
    return std::ranges::count(points.scene.sweep->seeds.kinds, SeedKind::random) > 0;
}

// The scene's problem at the ends of all ranges.
std::vector<sim::Problem> problems_at_ends(const SweptPoints& points) {
    std::vector<sim::Problem> out;
    const auto add = [&](const std::string& key, double value) {
        set_number(out.emplace_back(points.scene.problem), key, value);
    };
    for (const output::SweepAxis& axis : points.data.axes)
        for (const double value : {std::ranges::min(axis.values), std::ranges::max(axis.values)}) add(axis.name, value);
    if (has_random_starts(points))
        for (const RandomKey& each : random_keys(*points.scene.sweep, points.scene.problem))
            add(each.key, each.from), add(each.key, each.to);
    return out;
}

// "every impact in 60 cam turns after a transient of 500 cam turns"
std::string sampling_text(const sim::Sampling& sampling) {
    static const std::map<sim::SampleKind, const char*> kWhat{{sim::SampleKind::impacts, "every impact"},
                                                              {sim::SampleKind::section, "one sample a turn"},
                                                              {sim::SampleKind::apexes, "every maximum of $θ$"},
                                                              {sim::SampleKind::crossings, "every crossing"},
                                                              {sim::SampleKind::peaks, "largest values"}};
    const auto text = [](const sim::CamSpan& span) {
        return span.time ? render::quantity(*span.time, "s") : fmt::format("{:g} cam turns", span.turns);
    };
    return fmt::format("{} in {} after a transient of {}", kWhat.at(sampling.kind), text(sampling.keep),
                       text(sampling.transient));
}

// "; classes: periodic, chaotic" of those in a legend, and what a white cell means.
std::string classes_text(const figure::Figure& of) {
    std::vector<std::string> names;
    bool white = false;
    for (const figure::Panel& panel : of.panels) {
        for (const figure::Swatch& each : panel.swatches) names.push_back(each.label);
        for (const figure::Cells& cells : panel.cells)
            white = white || std::ranges::find(cells.colors, render::Color{0, 0, 0, 0}) != cells.colors.end();
    }
    if (white && !names.empty()) names.push_back("white where there is no motion");
    return names.empty() ? "" : fmt::format("; classes: {}", fmt::join(names, ", "));
}

std::string tolerance_text(const SweptPoints& points) {
    const sim::Problem& problem = points.scene.problem;
    const bool closed =
        problem.beam.model == sim::ModelKind::rigid && problem.contact.model == sim::ContactModel::restitution;
    return fmt::format("Relative tolerance {}{}.", one_digit(problem.solver.rtol),
                       closed ? ", or rounding where the rigid beam is followed in closed form" : "");
}

// ---- all samples in one plane ---------------------------------------------------------------------

constexpr std::uint32_t kValueColors[] = {0x000000, 0xD55E00, 0x0072B2, 0x009E73, 0xCC79A7, 0xE69F00};

bool has_many_values(const SweptPoints& points) {
    return points.data.axes.size() == 1 && points.axis(0).values.size() > std::size(kValueColors);
}

// A cloud for each value of one key, in the colours of a map if they are many; of two keys one cloud.
std::vector<figure::Cloud> clouds_of_values(const SweptPoints& points) {
    const output::SweepAxis& axis = points.axis(0);
    if (points.data.axes.size() > 1) return {{"", {}, {}, rgb(0x000000)}};
    std::vector<figure::Cloud> clouds;
    if (has_many_values(points)) {
        const auto [least, most] = std::ranges::minmax(axis.values);
        for (const double value : axis.values)
            clouds.push_back({.color = figure::map_color((value - least) / (most - least))});
        return clouds;
    }
    for (std::size_t i = 0; i < axis.values.size(); ++i)
        clouds.push_back({value_label(symbol_of(axis.name), axis.values[i], axis.unit), {}, {}, rgb(kValueColors[i])});
    if (clouds.size() == 1) clouds[0].label.clear();
    return clouds;
}

// A Poincaré section, or a map of each impact to the next. `x`, `y`: columns of the samples; `next`: y is that of the
// sample after.
figure::Figure sample_plane(const SweptPoints& points, const std::string& x, const std::string& y, bool next) {
    const std::size_t cx = points.column(x), cy = points.column(y), width = points.data.columns.size();
    std::vector<figure::Cloud> clouds = clouds_of_values(points);
    for (std::uint64_t k = 0; k < points.data.points(); ++k) {
        if (!points.data.has(k)) continue;
        const output::StoredPoint p = points.data.read(k);
        if (!has_section(kind_of(p))) continue;
        figure::Cloud& cloud = clouds[clouds.size() > 1 ? k / points.seeds() : 0];
        const std::size_t later = next ? width : 0;
        for (std::size_t i = 0; i + later < p.samples.size(); i += width)
            cloud.add(drawn(points, cx, p.samples[i + cx]), drawn(points, cy, p.samples[i + later + cy]));
    }
    if (all_empty(clouds))
        throw render::PictureError(
            "no point has a section to show: all rest, follow the cam, have left it or have not settled");
    const auto axis = [&](std::size_t c, const char* which) -> render::Axis {
        const std::string label = column_label(points, c);
        return {.label = next ? phrase(points.lang, which, label) : label};
    };
    figure::Panel panel{
        .x = axis(cx, "{}, impact $k$"), .y = axis(cy, "{}, impact $k$ + 1"), .clouds = std::move(clouds), .name = y};
    if (next)  // impacts that repeat
        panel.series.push_back({.x = {0, 1}, .y = {0, 1}, .solid = true, .weight = 0.5, .color = rgb(0x777777)});
    if (has_many_values(points)) {
        const auto [least, most] = std::ranges::minmax(points.axis(0).values);
        panel.color_bar = figure::ColorBar{.label = label_of(points.axis(0)), .from = least, .to = most};
    }
    return {.panels = {std::move(panel)}, .aspect = 0.9};
}

// A column of peaks over the key: points, a look for each start but random ones.
figure::Figure draw_peaks(const SweptPoints& points, const FigureOutput& how) {
    const std::size_t column = points.column(how.value.empty() ? "force_peak" : how.value);
    const output::TableColumn& info = points.data.columns[column];
    const bool random = points.seed(0) == SeedKind::random;
    std::vector<figure::Series> curves(random ? 1 : points.seeds());
    for (std::size_t i = 0; i < curves.size(); ++i) {
        curves[i] = {.look = static_cast<int>(i), .line = false, .every_point = true};
        if (curves.size() > 1) curves[i].label = phrase(points.lang, look_of(points.seed(i)).label);
    }
    double largest = 0;
    for (std::uint64_t k = 0; k < points.data.points(); ++k) {
        if (!points.data.has(k)) continue;
        const output::StoredPoint p = points.data.read(k);
        const double value = p.samples.empty() ? sim::kNan : p.samples[column];
        curves[random ? 0 : k % points.seeds()].add(points.value(k), value);
        if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
    }
    const Measure measure = measure_of(info.unit, largest);
    for (figure::Series& curve : curves)
        for (double& value : curve.y) value *= measure.factor;
    figure::Panel panel{.x = {.label = label_of(points.axis(0)), .scale = points.scale(0)},
                        .y = {.label = axis_label(symbol_of(info.name), measure.unit), .with_zero = true},
                        .series = std::move(curves),
                        .name = info.name};
    return {.panels = {std::move(panel)}, .aspect = 0.7};
}

// ---- the figures by name --------------------------------------------------------------------------

std::optional<std::string> needs_sweep(const Scene& scene) {
    if (scene.sweep) return std::nullopt;
    return "the scene has no \"sweep\"; give it one, or use beamcam sweep --over KEY=VALUES --diagram FILE";
}
std::optional<std::string> needs_one_key(const Scene& scene) {
    if (auto why = needs_sweep(scene)) return why;
    if (scene.sweep->over.size() == 1) return std::nullopt;
    return "the sweep varies two keys; \"map\" shows it";
}
std::optional<std::string> needs_two_keys(const Scene& scene) {
    if (auto why = needs_sweep(scene)) return why;
    if (scene.sweep->over.size() == 2) return std::nullopt;
    return "the sweep varies one key; a map needs two: \"over\" has to name another, or --over a second time";
}
std::optional<std::string> needs_two_starts(const Scene& scene) {
    if (auto why = needs_two_keys(scene)) return why;
    if (std::ranges::all_of(scene.sweep->over, [](const SweptKey& o) { return o.key.starts_with("initial."); }))
        return std::nullopt;
    return "basins are over two initial values; \"map\" shows other keys";
}
std::optional<std::string> needs_peaks(const Scene& scene) {
    if (auto why = needs_one_key(scene)) return why;
    if (scene.sweep->sampling.kind == sim::SampleKind::peaks) return std::nullopt;
    return "its samples are no peaks; set sweep.sample to \"peaks\"";
}
std::optional<std::string> needs_impacts(const Scene& scene) {
    if (auto why = needs_sweep(scene)) return why;
    if (scene.sweep->sampling.kind == sim::SampleKind::impacts) return std::nullopt;
    return "its samples are no impacts; set sweep.sample to \"impacts\"";
}

figure::Figure draw_poincare(const SweptPoints& points, const FigureOutput&) {
    return points.of_impacts() ? sample_plane(points, "cam_phase", "v_n_before", false)
                               : sample_plane(points, "theta", "theta_dot", false);
}
figure::Figure draw_impact_map(const SweptPoints& points, const FigureOutput&) {
    return sample_plane(points, "cam_phase", "cam_phase", true);
}

}  // namespace

extern const FigureType kBifurcation{.name = "bifurcation",
                                     .title = "Bifurcation diagram",
                                     .refusal = needs_one_key,
                                     .draw = bifurcation,
                                     .keys = {"value"}};
extern const FigureType kPeaks{
    .name = "peaks", .title = "Peaks", .refusal = needs_peaks, .draw = draw_peaks, .keys = {"value"}};
extern const FigureType kBasins{
    .name = "basins", .title = "Basins of attraction", .refusal = needs_two_starts, .draw = key_map, .keys = {"value"}};
extern const FigureType kMap{
    .name = "map", .title = "Map of motions", .refusal = needs_two_keys, .draw = key_map, .keys = {"value"}};
extern const FigureType kPoincare{
    .name = "poincare", .title = "Poincaré section", .refusal = needs_sweep, .draw = draw_poincare};
extern const FigureType kImpactMap{
    .name = "impact-map", .title = "Map of impacts", .refusal = needs_impacts, .draw = draw_impact_map};

FigureDrawing swept_figure(const FigureType& type, const FigureOutput& how) {
    return [&type, how](const Subject&, const MotionResults& results) {
        if (!results.sweep) throw std::logic_error("a figure of a sweep without its points");
        const SweptPoints points(*results.sweep, how.lang);
        figure::Figure out = type.draw(points, how);
        std::vector<std::string> keys;
        for (const output::SweepAxis& axis : points.axes()) keys.push_back(key_text(axis.name));
        out.title = fmt::format("{} over {}: {}{}", type.title, fmt::join(keys, " and "),
                                sampling_text(points.scene.sweep->sampling), classes_text(out));
        add_caption(out, problems_at_ends(points), points.scene.units);
        out.accuracy = tolerance_text(points);
        return out;
    };
}

std::string usual_diagram(const Scene& scene) {
    for (const FigureType& type : figure_types())
        if (type.of_sweep() && !type.refusal(scene)) return type.name;
    return kPoincare.name;
}

std::vector<std::string> diagram_values(std::string_view diagram, const Scene& scene) {
    std::vector<std::string> known;
    if (diagram != kBifurcation.name && diagram != kPeaks.name)
        known.assign(std::begin(kMapValues), std::end(kMapValues));
    for (const sim::SampleColumnInfo& column : sim::sample_columns())
        if (column.is_of(scene.sweep->sampling.kind)) known.emplace_back(column.name);
    return known;
}

std::vector<std::string> diagram_names() {
    std::vector<std::string> names;
    for (const FigureType& type : figure_types())
        if (type.of_sweep()) names.emplace_back(type.name);
    return names;
}

}  // namespace beamcam::scenes
