// The figure "table": columns of a file over another one, with one panel for each unit.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "render/draw/markup.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"

namespace beamcam::scenes {
namespace {

constexpr std::size_t kMostMarks = 60;  // of a curve, which more of them hide

using Column = PlottedTable::Column;

// "Force" of the heading "Force (kN)", whose unit the axis names; columns of beamcam have symbols.
std::string label_of(const Column& column) {
    const std::size_t bracket = column.name.find_last_of("([");
    const bool has_unit = bracket != std::string::npos && bracket > 0 && !column.prefixed &&
                          (column.name.ends_with(')') || column.name.ends_with(']'));
    std::string name = column.name.substr(0, has_unit ? bracket : std::string::npos);
    while (name.ends_with(' ')) name.pop_back();
    return symbol_of(name);
}

Measure measure_in_figure(const Column& column, double largest, const render::Units& units) {
    return column.prefixed ? measure_of(column.unit, largest, units) : Measure{1, column.unit};
}

// Points that go forth and back, or are many at one place, are samples of several motions and not joined. A motion has
// two rows at an instant where it jumps.
bool is_curve(const std::vector<double>& x) {
    for (std::size_t i = 2; i < x.size(); ++i)
        if (x[i] == x[i - 2]) return false;
    return std::ranges::is_sorted(x) || std::ranges::is_sorted(x, std::ranges::greater());
}

void add_column(Panel& panel, const std::vector<double>& x, const Column& column, double factor, bool named) {
    const bool joined = is_curve(x);
    const std::string label = named ? label_of(column) : "";
    if (!joined && x.size() > kMostMarks) {
        const auto look = render::figure::look(static_cast<int>(panel.clouds.size()));
        panel.clouds.push_back({label, x, scaled(column.values, factor), look.color});
    } else {
        panel.series.push_back({.label = label,
                                .x = x,
                                .y = scaled(column.values, factor),
                                .name = column.name,
                                .look = static_cast<int>(panel.series.size()),
                                .line = joined,
                                .every_point = !joined || x.size() <= kMostMarks});
    }
}

Panel panel_of(const std::vector<Column>& columns, const std::vector<double>& x, const std::string& label,
               const render::Units& units) {
    double largest = 0;
    std::vector<std::string> names;
    for (const Column& column : columns) {
        largest = std::max(largest, largest_magnitude(column.values));
        names.push_back(label_of(column));
    }
    const Measure measure = measure_in_figure(columns.front(), largest, units);
    Panel panel{.name = columns.front().name};
    panel.y.label = axis_label(label.empty() ? fmt::format("{}", fmt::join(names, ", ")) : label, measure.unit);
    panel.y.keeps_unit = !columns.front().prefixed;
    for (const Column& column : columns) add_column(panel, x, column, measure.factor, columns.size() > 1);
    return panel;
}

Figure draw_table(const PlottedTable& table, const render::Units& units) {
    const Column& x = table.columns.front();
    const Measure along = measure_in_figure(x, largest_magnitude(x.values), units);
    const std::vector<double> places = scaled(x.values, along.factor);
    std::vector<std::vector<Column>> groups;  // by unit
    for (std::size_t i = 1; i < table.columns.size(); ++i) {
        const Column& column = table.columns[i];
        const auto same = std::ranges::find_if(groups, [&](const auto& g) { return g.front().unit == column.unit; });
        (same == groups.end() ? groups.emplace_back() : *same).push_back(column);
    }
    Figure figure{.title = fmt::format("{} over {}", render::escaped(fmt::format("{}", fmt::join(table.y, ", "))),
                                       render::escaped(table.x)),
                  .stack = true,
                  .share_x = true,
                  .aspect = 0.3 + 0.36 * static_cast<double>(groups.size())};
    for (const auto& group : groups) {
        figure.panels.push_back(panel_of(group, places, groups.size() == 1 ? table.label : "", units));
        figure.panels.back().x.keeps_unit = !x.prefixed;
        figure.panels.back().x.label = axis_label(table.x_label.empty() ? label_of(x) : table.x_label, along.unit);
    }
    figure.panels = lettered(std::move(figure.panels));
    return figure;
}

FigureDrawing prepare_table(const Scene& scene, const FigureOutput& how, MotionRequests&) {
    return [table = how.table, units = scene.units](const Subject&, const MotionResults&) {
        return draw_table(table, units);
    };
}

}  // namespace

extern const FigureType kTable{.name = "table",
                               .title = "Columns of a table, of beamcam or of other programs",
                               .refusal = no_refusal,
                               .maker = prepare_table,
                               .keys = {"table"}};

}  // namespace beamcam::scenes
