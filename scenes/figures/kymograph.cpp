// The deflection along the beam in time, as colours.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/plot/ticks.hpp"
#include "scenes/figures/figure_types.hpp"

namespace beamcam::scenes {
namespace {

constexpr int kColumns = 600, kStations = 65;  // a printed column resolves no more
constexpr int kMostSamples = 16;               // of a column

// Instants per column: more than one where the vibration is faster than the columns, so that it is not aliased.
std::size_t samples_per_column(const sim::Problem& problem, double column) {
    const std::vector<double> frequencies = frequencies_of(problem);
    if (frequencies.empty()) return 1;
    const double periods = column * frequencies.front();
    return periods < 0.25 ? 1 : static_cast<std::size_t>(std::clamp(std::ceil(8 * periods), 2.0, double(kMostSamples)));
}

// The value of the largest magnitude in each column, for each station.
std::vector<double> extremes(const std::vector<sim::Pose>& poses, std::size_t samples) {
    std::vector<double> out(kColumns * kStations, 0);
    for (std::size_t row = 0; row < poses.size(); ++row) {
        const std::vector<double> v = sim::deflection(poses[row]);
        for (std::size_t i = 0; i < kStations; ++i)
            if (double& most = out[row / samples * kStations + i];
                row % samples == 0 || std::abs(v[i]) > std::abs(most))
                most = v[i];
    }
    return out;
}

// Deflections as colours, of each column and station.
render::figure::Cells cells_of_deflection(const std::vector<double>& v, const ShownPoses& shown, double length,
                                          double least, double range, double unit) {
    render::figure::Cells cells;
    for (int k = 0; k <= kColumns; ++k) cells.x.push_back(shown.from + (shown.to - shown.from) * k / kColumns);
    for (int i = 0; i <= kStations; ++i) cells.y.push_back(length * i / kStations);
    for (std::size_t i = 0; i < kStations; ++i)
        for (std::size_t k = 0; k < kColumns; ++k)
            cells.colors.push_back(render::figure::map_color((v[k * kStations + i] - least) / range)),
                cells.values.push_back(v[k * kStations + i] / unit);
    return cells;
}

Panel kymograph_panel(const std::vector<double>& v, const ShownPoses& shown, double length) {
    const auto [least, most] = std::ranges::minmax(v);
    const render::Prefix prefix = render::prefix_for(std::max(-least, most));
    const double range = most > least ? most - least : 1;
    return {.x = {.label = "$t$ / s", .tight = true},
            .y = {.label = "$x$ / m", .tight = true},
            .cells = {cells_of_deflection(v, shown, length, least, range, prefix.factor)},
            .color_bar = render::figure::ColorBar{.label = fmt::format("$v$($x$, $t$) / {}m", prefix.symbol),
                                                  .from = least / prefix.factor,
                                                  .to = (least + range) / prefix.factor},
            .legend = Legend::none};
}

FigureMaker prepare_kymograph(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const double column = (how.series.to.value_or(scene.end_time) - how.series.from) / kColumns;
    const std::size_t samples = samples_per_column(scene.problem, column);
    const ShownPoses shown = request_poses(scene, how, kColumns * static_cast<int>(samples), kStations, studies);
    return [=, problem = scene.problem, lang = how.lang](const Results& results) -> Figure {
        const sim::Result& result = *results[shown.study];
        Panel panel = kymograph_panel(extremes(result.poses[shown.poses], samples), shown, problem.beam.length);
        for (const sim::Impact& hit : strikes(problem, result.impacts, shown.from, shown.to))
            panel.marks.push_back({.x = hit.t_start, .y = hit.x, .look = 1, .hollow = true});
        std::string caption = phrase(lang,
                                     "Deflection $v$($x$, $t$) from the tangent at the root, along the beam and in "
                                     "time, one column every {} s. ",
                                     "相对根部切线的挠度 $v$($x$, $t$) 沿梁长与时间的分布，每列 {} s。",
                                     number((shown.to - shown.from) / (kColumns - 1), 2));
        if (samples > 1)
            caption += phrase(lang,
                              "The beam vibrates faster than the columns: each shows the largest deflection of {} "
                              "instants. ",
                              "一列之内梁多次振动，取 {} 个时刻中的最大挠度。", samples);
        if (!panel.marks.empty()) caption += phrase(lang, "Squares: impacts. ", "标记：冲击。");
        return {.panels = {std::move(panel)},
                .caption = caption + facts(problem, lang),
                .accuracy = accuracy({{&problem, &result}}, lang)};
    };
}

std::optional<std::string> needs_bending(const Scene& scene) {
    if (scene.problem.beam.model != sim::ModelKind::rigid) return std::nullopt;
    return "a rigid beam does not bend; choose another beam.model";
}

}  // namespace

extern const FigureType kKymograph{.name = "kymograph",
                                   .title = {"Deflection along the beam in time", "梁挠度的时空图"},
                                   .refusal = needs_bending,
                                   .maker = prepare_kymograph,
                                   .keys = {"from", "to"}};

}  // namespace beamcam::scenes
