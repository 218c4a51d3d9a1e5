#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "render/base/error.hpp"
#include "render/plot/style.hpp"
#include "scenes/figures/swept_points.hpp"

namespace beamcam::scenes {

namespace figure = render::figure;
using render::Color;
using render::rgb;
using sim::AttractorClass;

namespace {

// Colours of the periods one to five; longer periods have the last one.
constexpr std::uint32_t kPeriodColors[] = {0x08306B, 0x2171B5, 0x6BAED6, 0x9ECAE1, 0xC6DBEF};
// The entry of a cell: periodic motions by their period, others by their class.
figure::Swatch map_entry(const output::StoredPoint& p, Lang lang) {
    if (kind_of(p) != AttractorClass::periodic) return {class_label(kind_of(p), lang), color_of(kind_of(p))};
    const int most = static_cast<int>(std::size(kPeriodColors)), shown = std::min(p.period, most);
    return {phrase(lang, shown == most ? "period {} and more" : "period {}", shown), rgb(kPeriodColors[shown - 1])};
}

// A number of the point, or the mean of a column of its samples; NaN: none; −∞: an exponent after lasting contact.
double map_value(const SweptPoints& points, const output::StoredPoint& p, const std::string& value) {
    if (value == "exponent") return p.exponent;
    if (value == "impacts_per_period") return p.impacts_per_period;
    const std::size_t column = points.column(value), width = points.data.columns.size();
    double sum = 0;
    for (std::size_t i = column; i < p.samples.size(); i += width) sum += drawn(points, column, p.samples[i]);
    const std::size_t rows = p.samples.size() / width;
    return rows == 0 ? sim::kNan : sum / static_cast<double>(rows);
}

std::string map_label(const SweptPoints& points, const std::string& value) {
    if (value == "exponent") return phrase(points.lang, "largest exponent / s^{−1}");
    if (value == "impacts_per_period") return phrase(points.lang, "impacts per period, or per turn of the cam");
    return phrase(points.lang, "mean of {}", column_label(points, points.column(value)));
}

void color_by_class(const SweptPoints& points, const std::vector<output::StoredPoint>& entries, figure::Panel& panel) {
    std::map<std::pair<int, std::size_t>, figure::Swatch> swatches;  // in the order of classes, then of periods
    for (const output::StoredPoint& p : entries) {
        const figure::Swatch entry = map_entry(p, points.lang);
        panel.cells[0].colors[p.point] = entry.color;
        const auto period = static_cast<std::size_t>(std::max(p.period, 0));
        swatches.emplace(std::pair(p.kind, std::min(period, std::size(kPeriodColors))), entry);
    }
    for (const auto& [order, entry] : swatches) panel.swatches.push_back(entry);
}

std::string orbit_label(const output::StoredPoint& p, Lang lang) {
    return phrase(lang, "{0} turn{1}, {2:g} impact{3}", p.period, p.period == 1 ? "" : "s", p.impacts_per_period,
                  p.impacts_per_period == 1 ? "" : "s");
}

// Basins are those of attractors: of each class and, if it is periodic, of each period with each number of impacts. The
// colours of periodic ones repeat after six.
constexpr std::uint32_t kAttractorColors[] = {0x0072B2, 0x56B4E9, 0xCC79A7, 0xE69F00, 0x08306B, 0x8C510A};
void color_by_attractor(const SweptPoints& points, const std::vector<output::StoredPoint>& entries,
                        figure::Panel& panel) {
    std::map<std::tuple<int, int, double>, std::vector<const output::StoredPoint*>> basins;
    const auto is_periodic = [](const output::StoredPoint& p) { return kind_of(p) == AttractorClass::periodic; };
    for (const output::StoredPoint& p : entries)
        basins[is_periodic(p) ? std::tuple(p.kind, p.period, p.impacts_per_period) : std::tuple(p.kind, 0, 0.0)]
            .push_back(&p);
    std::size_t next = 0;
    for (const auto& [attractor, cells] : basins) {
        figure::Swatch entry = map_entry(*cells.front(), points.lang);
        if (is_periodic(*cells.front()))
            entry = {orbit_label(*cells.front(), points.lang),
                     rgb(kAttractorColors[next++ % std::size(kAttractorColors)])};
        for (const output::StoredPoint* p : cells) panel.cells[0].colors[p->point] = entry.color;
        panel.swatches.push_back(entry);
    }
}

// Beside colours that are nearly white at 0.
constexpr Color kUnknown{0.66, 0.66, 0.66}, kMinusInfinity{0.33, 0.33, 0.33};

// Cells without a number stay white; beside numbers of both signs they are grey, with an entry in the legend.
void color_by_value(const SweptPoints& points, const std::vector<output::StoredPoint>& entries,
                    const std::string& value, figure::Panel& panel) {
    figure::Cells& cells = panel.cells[0];
    cells.values.assign(cells.colors.size(), sim::kNan);
    for (const output::StoredPoint& p : entries) cells.values[p.point] = map_value(points, p, value);
    render::Extent numbers;
    numbers.add(cells.values);
    auto [any, low, high] = numbers;
    if (!any) throw render::PictureError(fmt::format("no point of this sweep has a number for \"{}\"", value));
    const bool both_signs = low < 0 && high > 0;
    if (low == high) low -= 0.5, high += 0.5;
    if (both_signs) high = std::max(-low, high), low = -high;
    for (std::size_t i = 0; i < cells.colors.size(); ++i) {
        const double number = cells.values[i];
        if (both_signs)
            cells.colors[i] = std::isfinite(number) ? figure::signed_color(number / high)
                              : std::isnan(number)  ? kUnknown
                                                    : kMinusInfinity;
        else if (std::isfinite(number))
            cells.colors[i] = figure::map_color((number - low) / (high - low));
        if (!std::isfinite(number)) cells.values[i] = sim::kNan;
    }
    panel.color_bar =
        figure::ColorBar{.label = map_label(points, value), .from = low, .to = high, .is_signed = both_signs};
    panel.legend = both_signs;
    const auto explain = [&](Color color, std::string label) {
        if (std::ranges::find(cells.colors, color) != cells.colors.end())
            panel.swatches.push_back({std::move(label), color});
    };
    if (both_signs) explain(kUnknown, phrase(points.lang, "unknown")), explain(kMinusInfinity, "−∞");
}

}  // namespace

figure::Figure key_map(const SweptPoints& points, const FigureOutput& how) {
    const std::string value = how.value.empty() ? kMapValues[0] : how.value;
    const output::SweepAxis &across = points.axis(0), &up = points.axis(1);
    const std::vector<std::size_t> column = ranks(across.values), row = ranks(up.values);
    figure::Panel panel{
        .x = {.label = label_of(across), .scale = points.scale(0), .tight = true},
        .y = {.label = label_of(up), .scale = points.scale(1), .tight = true},
        .cells = {{edges_around(across.values, points.scale(0)), edges_around(up.values, points.scale(1)), {}}},
        .name = value};
    panel.cells[0].colors.assign(across.values.size() * up.values.size(), Color{0, 0, 0, 0});
    std::vector<output::StoredPoint> entries;  // of the first start; `point` is the place of its cell
    for (std::uint64_t k = 0; k < points.data.points(); k += points.seeds()) {
        if (!points.data.has(k)) continue;
        const std::uint64_t cell = k / points.seeds(), width = across.values.size();
        output::StoredPoint p = points.data.read(k);
        if (!p.failure.empty()) continue;  // its cell stays white
        entries.push_back(std::move(p));
        entries.back().point = row[cell / width] * width + column[cell % width];
    }
    if (value == "class" && how.figure == "basins")
        color_by_attractor(points, entries, panel);
    else if (value == "class")
        color_by_class(points, entries, panel);
    else
        color_by_value(points, entries, value, panel);
    return {.panels = {std::move(panel)}, .aspect = 0.9};
}

}  // namespace beamcam::scenes
