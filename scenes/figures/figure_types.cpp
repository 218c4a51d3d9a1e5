#include "scenes/figures/figure_types.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/figures/sweeps.hpp"
#include "sim/beam/modes.hpp"

namespace beamcam::scenes {

// Each is in its file of this folder.
extern const FigureType kSeries, kSchematic, kFreeFall, kDeflection, kDistance, kContactPlaces, kKymograph,
    kSpectrogram, kStrobe, kSvaj, kTable, kImpactMaps, kPeaks, kBifurcation, kBasins, kMap, kPoincare, kImpactMap;

namespace {

// Made on first use: the types are initialized before.
const std::vector<FigureType>& table() {
    static const std::vector<FigureType> all{kSeries,        kSchematic,  kFreeFall,    kDeflection,  kDistance,
                                             kContactPlaces, kKymograph,  kSpectrogram, kStrobe,      kSvaj,
                                             kTable,         kImpactMaps, kPeaks,       kBifurcation, kBasins,
                                             kMap,           kPoincare,   kImpactMap};
    return all;
}

}  // namespace

// Times over less than a tenth of a second are in milliseconds or less.
static void shorten_times(std::vector<Panel>& panels) {
    constexpr double kShort = 0.1;  // [s]
    render::Extent times;
    const auto is_in_seconds = [](const Panel& panel) { return panel.x.label == "$t$ / s"; };
    for (const Panel& panel : panels) {
        if (!is_in_seconds(panel)) continue;
        for (const Series& series : panel.series) times.add(series.x);
        for (const auto& cells : panel.cells) times.add(cells.x);
        for (const auto& end : {panel.x.from, panel.x.to})
            if (end) times.add({&*end, 1});
    }
    if (!times.any || times.high - times.low >= kShort) return;
    for (Panel& panel : panels) panel.x.short_numbers = panel.x.short_numbers || is_in_seconds(panel);
}

FigureMaker FigureType::prepare(const Scene& scene, const FigureOutput& how, MotionRequests& requests) const {
    return [draw = of_sweep() ? swept_figure(*this, how) : maker(scene, how, requests),
            subject = subject_of(scene, how.lang), called = std::string(name), chosen = how.title,
            usual = title](const MotionResults& results) {
        render::figure::Figure figure = draw(subject, results);
        figure.name = called;
        if (figure.title.empty()) figure.title = usual;
        figure.title = title_with_panels(chosen.empty() ? figure.title : chosen, figure.panels);
        shorten_times(figure.panels);
        return figure;
    };
}

std::optional<std::string> FigureType::misplaced(std::string_view key) const {
    const std::size_t others = figures_with(key).size();
    if (takes(key) || others == 0) return std::nullopt;
    return fmt::format("belongs to the figure{} {}; remove it", others > 1 ? "s" : "", list_of_figures_with(key));
}

std::span<const FigureType> figure_types() { return table(); }

std::vector<std::string> figure_names() {
    std::vector<std::string> names;
    for (const FigureType& type : figure_types()) names.emplace_back(type.name);
    return names;
}

std::vector<std::string_view> keys_of_figures() {
    std::vector<std::string_view> all;
    for (const FigureType& type : figure_types())
        for (const std::string_view key : type.keys)
            if (std::ranges::find(all, key) == all.end()) all.push_back(key);
    return all;
}

std::vector<std::string> figures_with(std::string_view key) {
    std::vector<std::string> names;
    for (const FigureType& type : figure_types())
        if (type.takes(key)) names.emplace_back(type.name);
    return names;
}

std::string list_of_figures_with(std::string_view key) {
    std::vector<std::string> quoted;
    for (const std::string& name : figures_with(key)) quoted.push_back(fmt::format("\"{}\"", name));
    const std::string last = quoted.back();
    quoted.pop_back();
    return quoted.empty() ? last : fmt::format("{} and {}", fmt::join(quoted, ", "), last);
}

const FigureType* figure_type(std::string_view name) {
    const auto it = std::ranges::find(table(), name, &FigureType::name);
    return it == table().end() ? nullptr : &*it;
}

std::optional<std::string> refusal_of_variants(std::initializer_list<sim::Problem> variants) {
    for (const sim::Problem& variant : variants)
        for (const sim::Issue& finding : sim::validate(variant))
            if (finding.fatal)
                return fmt::format("it computes a variant of the scene too, in which {}: {}", finding.path,
                                   finding.message);
    return std::nullopt;
}

std::optional<std::string> needs_cam(const Scene& scene) {
    if (scene.problem.cam) return std::nullopt;
    return "the scene has no cam (\"cam\": null); give it one";
}

std::optional<std::string> needs_bending(const Scene& scene) {
    if (scene.problem.beam.model != sim::ModelKind::rigid) return std::nullopt;
    return "a rigid beam does not bend; choose another beam.model";
}

std::optional<std::string> needs_free_hub(const Scene& scene) {
    if (!sim::is_prescribed(scene.problem.hub.drive)) return std::nullopt;
    return "the hub's motion is prescribed, so it cannot fall; set hub.drive to {\"type\": \"free\"}";
}

std::optional<std::string> needs_start_off_the_cam(const Scene& scene) {
    if (scene.problem.initial.shape != sim::InitialShape::resting) return std::nullopt;
    return "the beam rests on the cam at the start, so it has no motion without the cam; set initial.shape to "
           "\"straight\" or \"static\"";
}

std::vector<Panel> lettered(std::vector<Panel> panels) {
    char letter = 'a';
    for (Panel& panel : panels)
        if (panels.size() > 1) panel.letter = letter++;
    return panels;
}

const sim::Collision* collision_of(const sim::Problem& problem, const sim::Result& result, int number) {
    for (const sim::Collision& each : result.collisions)
        if (strikes(problem, each) && --number == 0) return &each;
    return nullptr;
}

int contact_rows(double end) { return static_cast<int>(std::clamp(end / 2e-5, 4e4, 4e5)) + 1; }

FigureDrawing figure_of_motion(std::size_t motion, MotionDrawing draw) {
    return [motion, draw = std::move(draw)](const Subject& subject, const MotionResults& results) {
        Figure figure = draw(subject, *results[motion]);
        add_caption(figure, {{&subject.problem, results[motion]}}, subject.units);
        return figure;
    };
}

ShownPoses request_poses(const Scene& scene, const FigureOutput& how, int count, int stations,
                         MotionRequests& requests) {
    ShownPoses out{how.series.from, how.series.to.value_or(scene.end_time)};
    out.motion = requests.motion(scene.problem, out.to);
    std::vector<sim::PoseRequest>& poses = requests.request(out.motion).poses;
    out.poses = poses.size();
    poses.push_back({.times = instants({out.from, out.to, count}), .stations = stations});
    return out;
}

std::vector<double> frequencies_of(const sim::Problem& problem) {
    std::vector<double> all;
    for (const sim::Mode& mode : sim::natural_modes(problem))
        if (mode.omega > 0 && std::isfinite(mode.omega)) all.push_back(mode.omega / (2 * std::numbers::pi));
    return all;
}

sim::Problem without_cam(sim::Problem problem) {
    problem.cam.reset();
    return problem;
}

sim::Problem rigid(sim::Problem problem) {
    set_shapes(problem, sim::ModelKind::rigid, problem.beam.basis, problem.beam.modes);
    return problem;
}

std::vector<double> scaled(std::vector<double> values, double factor) {
    for (double& v : values) v *= factor;
    return values;
}

}  // namespace beamcam::scenes
