#include "scenes/figures/recipes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace beamcam::scenes {
namespace {

const std::array kRecipes{
    &kSeries,    &kSchematic,  &kFreeFall,         &kTipVibration, &kDeflection, &kDistance, &kAngle,     &kSpeeds,
    &kCollision, &kEnergy,     &kContactPlaces,    &kPhase,        &kApexModes,  &kModels,   &kKymograph, &kSpectrogram,
    &kStrobe,    &kImpactMaps, &kImpactHistograms, &kBifurcation,  &kBasins,     &kMap,      &kPoincare,  &kImpactMap};

const std::vector<Recipe>& table() {
    static const std::vector<Recipe> all = [] {
        std::vector<Recipe> made;
        for (const Recipe* recipe : kRecipes) made.push_back(*recipe);
        return made;
    }();
    return all;
}

}  // namespace

std::span<const Recipe> recipes() { return table(); }

std::vector<std::string> recipe_names() {
    std::vector<std::string> names;
    for (const Recipe& recipe : recipes()) names.emplace_back(recipe.name);
    return names;
}

const Recipe* recipe_named(std::string_view name) {
    const auto it = std::find_if(table().begin(), table().end(), [&](const Recipe& r) { return name == r.name; });
    return it == table().end() ? nullptr : &*it;
}

std::optional<std::string> refusal_of(const Recipe& recipe, const Scene& scene) {
    if (auto why = recipe.refusal(scene)) return why;
    Studies studies;
    recipe.prepare(scene, {}, studies);
    for (const Study& study : studies.take()) {
        if (study.may_fail) continue;
        for (const sim::Issue& finding : sim::validate(study.problem))
            if (finding.fatal)
                return fmt::format("it computes a variant of the scene too, in which {}: {}", finding.path,
                                   finding.message);
    }
    return std::nullopt;
}

std::optional<std::string> needs_cam(const Scene& scene) {
    if (scene.problem.cam) return std::nullopt;
    return "the scene has no cam (\"cam\": null); give it one";
}

std::optional<std::string> needs_free_hub(const Scene& scene) {
    if (!sim::is_prescribed(scene.problem.hub.drive)) return std::nullopt;
    return "the hub's motion is prescribed, so it cannot fall; set hub.drive to {\"type\": \"free\"}";
}

std::optional<std::string> needs_fall(const Scene& scene) {
    if (auto why = needs_free_hub(scene)) return why;
    return needs_start_off_the_cam(scene);
}

std::optional<std::string> needs_start_off_the_cam(const Scene& scene) {
    if (scene.problem.initial.shape != sim::InitialShape::resting) return std::nullopt;
    return "the beam rests on the cam at the start, so it has no motion without the cam; set initial.shape to "
           "\"straight\" or \"static\"";
}

const sim::Collision* collision_of(const sim::Problem& problem, const sim::Result& result, int number) {
    for (const sim::Collision& each : result.collisions)
        if (strikes(problem, each) && --number == 0) return &each;
    return nullptr;
}

std::optional<double> rebound_apex(const sim::Result& result, double end) {
    if (result.collisions.empty()) return std::nullopt;
    if (result.collisions.size() == 1 && result.end_time < end) return std::nullopt;
    const double after = result.collisions.front().t_end.value_or(result.end_time);
    // Ripple makes small maxima; the rebound is the highest of those before the next collision.
    const double until = result.collisions.size() > 1 ? result.collisions[1].t_start : result.end_time;
    std::optional<double> best;
    for (const sim::Apex& apex : result.apexes)
        if (apex.t > after && apex.t < until && (!best || apex.theta > *best)) best = apex.theta;
    return best;
}

int contact_rows(double end) { return static_cast<int>(std::clamp(end / 2e-5, 4e4, 4e5)) + 1; }

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
