// The deflection along the beam in time, as colours.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/plot/ticks.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"

namespace beamcam::scenes {
namespace {

constexpr int kColumns = 600, kStations = 129;  // a printed column resolves few more
constexpr int kMostSamples = 64;                // of a column
constexpr const char* kKymographTitle = "Deflection from the tangent at the root, along the beam and in time";

// Instants per column: more than one where the vibration is faster than the columns, so that it is not aliased. Sixteen
// in a period miss its largest deflection by less than 2 %.
std::size_t samples_per_column(const sim::Problem& problem, double column) {
    const std::vector<double> frequencies = frequencies_of(problem);
    if (frequencies.empty()) return 1;
    const double periods = column * frequencies.front();
    return periods < 0.25 ? 1
                          : static_cast<std::size_t>(std::clamp(std::ceil(16 * periods), 2.0, double(kMostSamples)));
}

// The value of each column and station: the deflection, or its largest magnitude of several instants.
std::vector<double> deflections(const std::vector<sim::Pose>& poses, std::size_t samples) {
    std::vector<double> out(kColumns * kStations, 0);
    for (std::size_t row = 0; row < poses.size(); ++row) {
        const std::vector<double> v = sim::deflection(poses[row]);
        for (std::size_t i = 0; i < kStations; ++i) {
            double& shown = out[row / samples * kStations + i];
            shown = samples == 1 ? v[i] : std::max(shown, std::abs(v[i]));
        }
    }
    return out;
}

Panel kymograph_panel(const std::vector<double>& v, const ShownPoses& shown, double length, bool magnitudes) {
    constexpr double kNegligible = 0.01;  // of the largest magnitude
    const auto [least, greatest] = std::ranges::minmax(v);
    const double most = std::max(-least, greatest);
    const bool is_signed = least < -kNegligible * most;
    const render::Prefix prefix = render::prefix_for(most);
    const double range = most > 0 ? most : 1;
    const render::figure::ColorBar bar{
        .label = fmt::format("{0}$v$($x$, $t$){0} / {1}m", magnitudes ? "|" : "", prefix.symbol),
        .from = is_signed ? -range / prefix.factor : 0,
        .to = range / prefix.factor,
        .is_signed = is_signed,
        .root = is_signed || magnitudes};
    const Measure place = measure_of("m", length);
    render::figure::Cells cells;
    for (int k = 0; k <= kColumns; ++k) cells.x.push_back(shown.from + (shown.to - shown.from) * k / kColumns);
    for (int i = 0; i <= kStations; ++i) cells.y.push_back(place.factor * length * i / kStations);
    for (std::size_t i = 0; i < kStations; ++i)
        for (std::size_t k = 0; k < kColumns; ++k) {
            const double share = v[k * kStations + i] / range;
            cells.colors.push_back(color_of(bar, is_signed ? 0.5 * (share + 1) : share));
            cells.values.push_back(v[k * kStations + i] / prefix.factor);
        }
    return {.x = {.label = "$t$ / s", .tight = true},
            .y = {.label = axis_label("$x$", place.unit), .tight = true},
            .cells = {std::move(cells)},
            .color_bar = bar,
            .legend = false};
}

FigureDrawing prepare_kymograph(const Scene& scene, const FigureOutput& how, MotionRequests& requests) {
    const double column = (how.series.to.value_or(scene.end_time) - how.series.from) / kColumns;
    const std::size_t samples = samples_per_column(scene.problem, column);
    const ShownPoses shown = request_poses(scene, how, kColumns * static_cast<int>(samples), kStations, requests);
    return figure_of_motion(shown.motion, [=](const Subject& subject, const sim::Result& result) -> Figure {
        const auto& [problem, units, lang, end] = subject;
        Panel panel =
            kymograph_panel(deflections(result.poses[shown.poses], samples), shown, problem.beam.length, samples > 1);
        if (panel.color_bar->root) panel.title = phrase(lang, "√ colours");
        std::string title = kKymographTitle;
        if (samples > 1) title += fmt::format("; |$v$|: the largest in each of {} intervals", kColumns);
        Series hits{.label = phrase(lang, "impacts"),
                    .name = "impact",
                    .look = 6,
                    .line = false,
                    .every_point = true};  // black
        for (const sim::Impact& hit : strikes(problem, result.impacts, shown.from, shown.to))
            if (hit.t_start > shown.from) hits.add(hit.t_start, hit.x * measure_of("m", problem.beam.length).factor);
        if (!hits.x.empty()) title += "; dots: impacts";
        panel.legend = !hits.x.empty();
        panel.series.push_back(std::move(hits));
        return {.title = std::move(title), .panels = {std::move(panel)}};
    });
}

}  // namespace

extern const FigureType kKymograph{.name = "kymograph",
                                   .title = kKymographTitle,
                                   .refusal = needs_bending,
                                   .maker = prepare_kymograph,
                                   .keys = {"from", "to"},
                                   .begins = Instant{.kind = Instant::Kind::collision},
                                   .ends = Instant{.kind = Instant::Kind::liftoff}};

}  // namespace beamcam::scenes
