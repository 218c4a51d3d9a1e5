#include <fmt/format.h>

#include <algorithm>

#include "output/json/tree.hpp"
#include "render/draw/markup.hpp"
#include "scenes/figures/command_figures.hpp"
#include "scenes/figures/figure_files.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::Cells;
using render::figure::Legend;
using render::figure::Panel;
using render::figure::Series;

struct OutcomeLook {
    sim::Outcome outcome;
    std::uint32_t color;
    const char* meaning;
};
constexpr OutcomeLook kOutcomes[] = {
    {sim::Outcome::closed, 0x2F6DB3, "closed energy balance"},
    {sim::Outcome::open, 0x9CC3E6, "open energy balance"},
    {sim::Outcome::refused, 0xC9CCD1, "rejected with a message"},
    {sim::Outcome::stopped, 0xE9A23B, "stopped with a message"},
    {sim::Outcome::failed, 0xC62828, "failed"},
};
render::Color color_of(sim::Outcome outcome) {
    return render::rgb(std::ranges::find(kOutcomes, outcome, &OutcomeLook::outcome)->color);
}

constexpr double kCellMargin = 0.04;  // free at each side of a cell, in cells

// Edges of `count` cells of `parts` stripes each; between neighbouring cells is an empty stripe.
std::vector<double> edges_of(std::size_t count, std::size_t parts) {
    std::vector<double> edges;
    for (std::size_t k = 0; k < count; ++k)
        for (std::size_t j = 0; j <= parts; ++j)
            edges.push_back(static_cast<double>(k) + kCellMargin +
                            (1 - 2 * kCellMargin) * static_cast<double>(j) / static_cast<double>(parts));
    return edges;
}

// The outcomes of the variants of each cell of a grid, row by row.
using GridOutcomes = std::vector<std::vector<sim::Outcome>>;

void add_stripes(const GridOutcomes& outcomes, std::size_t rows, std::size_t columns, Panel& panel) {
    std::size_t stripes = 1;
    for (const auto& cell : outcomes) stripes = std::max(stripes, cell.size());
    Cells& cells = panel.cells.emplace_back();
    cells.x = edges_of(columns, stripes), cells.y = edges_of(rows, 1);
    const std::size_t width = cells.x.size() - 1;
    cells.colors.assign(width * (cells.y.size() - 1), render::Color{0, 0, 0, 0});
    constexpr int kCrosses = 5;
    Series failed{
        .name = "failed", .look = kCrosses, .line = false, .every_point = true, .color = render::rgb(0xFFFFFF)};
    for (std::size_t at = 0; at < outcomes.size(); ++at) {
        const std::size_t up = 2 * (rows - 1 - at / columns), first = at % columns * (stripes + 1);
        for (std::size_t j = 0; j < stripes && !outcomes[at].empty(); ++j) {
            const sim::Outcome outcome = outcomes[at][j * outcomes[at].size() / stripes];
            cells.colors[up * width + first + j] = color_of(outcome);
            if (outcome != sim::Outcome::failed) continue;
            failed.add(0.5 * (cells.x[first + j] + cells.x[first + j + 1]), 0.5 * (cells.y[up] + cells.y[up + 1]));
        }
    }
    if (!failed.x.empty()) panel.series.push_back(std::move(failed));
}

// As markup, with superscripts that need no glyphs of their own.
std::string markup_of(const std::string& plain) {
    constexpr const char* kSuperscripts[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = render::escaped(plain);
    for (int digit = 0; digit < 10; ++digit) replace_all(text, kSuperscripts[digit], fmt::format("^{{{}}}", digit));
    return text;
}
std::vector<std::string> markup_of(const std::vector<std::string>& names) {
    std::vector<std::string> out;
    for (const std::string& name : names) out.push_back(markup_of(name));
    return out;
}

Panel grid_panel(const sim::CaseGrid& grid, const GridOutcomes& outcomes) {
    Panel panel{.title = markup_of(grid.title),
                .x = {.label = markup_of(grid.column_title), .names = markup_of(grid.columns)},
                .y = {.label = markup_of(grid.row_title), .names = markup_of(grid.rows)},
                .legend = Legend::none};
    std::ranges::reverse(panel.y.names);  // the first row is the highest
    add_stripes(outcomes, grid.rows.size(), grid.columns.size(), panel);
    return panel;
}

}  // namespace

render::figure::Figure survival_map(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results) {
    std::vector<GridOutcomes> outcomes;
    for (const sim::CaseGrid& grid : campaign.grids) outcomes.emplace_back(grid.rows.size() * grid.columns.size());
    for (std::size_t i = 0; i < campaign.cases.size(); ++i) {
        const sim::StressCase& one = campaign.cases[i];
        outcomes[one.grid][one.row * campaign.grids[one.grid].columns.size() + one.column].push_back(
            results[i].outcome);
    }
    render::figure::Figure figure;
    figure.name = "survival";
    figure.title = fmt::format("Survival at the extremes: {} cases", campaign.cases.size());
    for (std::size_t k = 0; k < campaign.grids.size(); ++k)
        figure.panels.push_back(grid_panel(campaign.grids[k], outcomes[k]));
    Panel& last = figure.panels.back();  // alone in its row, whose other plots the legend would move
    last.legend = Legend::above;
    for (const OutcomeLook& look : kOutcomes)
        last.swatches.push_back({fmt::format("{}: {}", look.meaning,
                                             std::ranges::count(results, look.outcome, &sim::StressResult::outcome)),
                                 render::rgb(look.color)});
    figure.aspect = 1.1 * static_cast<double>(figure.panels.size());
    return figure;
}

render::Image survival_picture(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results) {
    FigureOutput how;
    how.column = "elsevier-double";
    how.width = 0.3;
    how.dpi = 150;
    return figure_image(survival_map(campaign, results), how);
}

}  // namespace beamcam::scenes
