#include "scenes/figures/swept_points.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "render/base/error.hpp"

namespace beamcam::scenes {

namespace figure = render::figure;
using render::Color;
using sim::AttractorClass;

namespace {

struct ClassLook {
    AttractorClass kind;
    std::uint32_t color;
};
constexpr ClassLook kClasses[] = {
    {AttractorClass::rest, 0xF2F2F2},      {AttractorClass::following, 0xD0D0D0},
    {AttractorClass::periodic, 0x0072B2},  {AttractorClass::chaotic, 0xD55E00},
    {AttractorClass::aperiodic, 0x009E73}, {AttractorClass::over_the_top, 0x404040},
    {AttractorClass::unsettled, 0xF7EEA8},
};
const ClassLook& look_of(AttractorClass kind) { return *std::ranges::find(kClasses, kind, &ClassLook::kind); }

constexpr StartLook kStarts[] = {
    {SeedKind::same, "same start", "= "},
    {SeedKind::carry_up, "carried up", "→ "},
    {SeedKind::carry_down, "carried down", "← "},
    {SeedKind::random, "random starts", ""},
};
constexpr std::string_view kApproach = "v_n_before";

}  // namespace

SweptPoints::SweptPoints(const SweepResult& swept, Lang how)
    : scene(*swept.scene), data(*swept.data), lang(how), starts_(starts_of(scene.sweep->seeds)) {
    for (std::size_t i = 0; i < data.axes.size(); ++i) {
        output::SweepAxis axis = data.axes[i];
        Measure measure = measure_in(scene.units, axis.unit);
        if (measure.factor == 1 && scale(i) == render::Scale::linear)
            measure = measure_of(axis.unit, largest_magnitude(axis.values));
        axis.unit = measure.unit;
        for (double& each : axis.values) each *= measure.factor;
        axes_.push_back(std::move(axis));
        factors_.push_back(measure.factor);
    }
}

render::Scale SweptPoints::scale(std::size_t i) const {
    const bool logarithmic = scene.sweep->over[i].logarithmic && std::ranges::min(data.axes[i].values) > 0;
    return logarithmic ? render::Scale::logarithmic : render::Scale::linear;
}

std::size_t SweptPoints::column(const std::string& name) const {
    std::vector<std::string> known;
    for (std::size_t c = 0; c < data.columns.size(); ++c) {
        if (data.columns[c].name == name) return c;
        known.push_back(data.columns[c].name);
    }
    throw render::PictureError(
        fmt::format("the samples have no column {}; they have {}", name, fmt::join(known, ", ")));
}

Color color_of(AttractorClass kind) { return render::rgb(look_of(kind).color); }
std::string class_label(AttractorClass kind, Lang lang) { return phrase(lang, name(kind)); }

const StartLook& look_of(SeedKind kind) { return *std::ranges::find(kStarts, kind, &StartLook::kind); }

std::string column_label(const SweptPoints& points, std::size_t column) {
    const std::string& name = points.data.columns[column].name;
    const std::string unit = measure_in(points.scene.units, points.data.columns[column].unit).unit;
    if (name == "cam_phase") return phrase(points.lang, "cam phase / turn");
    if (name == kApproach) return axis_label(phrase(points.lang, "approach speed"), unit);
    return axis_label(symbol_of(name), unit);
}

double drawn(const SweptPoints& points, std::size_t column, double sample) {
    const output::TableColumn& one = points.data.columns[column];
    return one.name == kApproach ? -sample : measure_in(points.scene.units, one.unit).factor * sample;
}

std::string label_of(const output::SweepAxis& axis) { return axis_label(symbol_of(axis.name), axis.unit); }

std::vector<double> edges_around(std::vector<double> values, render::Scale scale) {
    if (scale == render::Scale::logarithmic) {
        for (double& value : values) value = std::log(value);
        values = edges_around(std::move(values), render::Scale::linear);
        for (double& edge : values) edge = std::exp(edge);
        return values;
    }
    std::ranges::sort(values);
    if (values.size() == 1) return {values[0] - 0.5, values[0] + 0.5};
    std::vector<double> edges{values[0] - 0.5 * (values[1] - values[0])};
    for (std::size_t i = 1; i < values.size(); ++i) edges.push_back(0.5 * (values[i - 1] + values[i]));
    edges.push_back(values.back() + 0.5 * (values.back() - values[values.size() - 2]));
    return edges;
}
std::vector<std::size_t> ranks(const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size()), rank(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
    for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
    return rank;
}

bool all_empty(const std::vector<figure::Cloud>& clouds) {
    return std::ranges::all_of(clouds, [](const figure::Cloud& cloud) { return cloud.x.empty(); });
}

}  // namespace beamcam::scenes
