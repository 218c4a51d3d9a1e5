#include "scenes/figures/sweeps.hpp"

#include <algorithm>
#include <stdexcept>

#include "scenes/figures/bifurcation_diagram.hpp"
#include "scenes/figures/key_map.hpp"
#include "scenes/figures/recipes.hpp"
#include "scenes/figures/sample_plane.hpp"
#include "scenes/figures/sweep_words.hpp"

namespace beamcam::scenes {
namespace {

namespace figure = render::figure;

using Draw = figure::Figure (*)(const SweptPoints& points, const FigureOutput& how);

template <const Recipe& recipe, Draw draw>
FigureMaker prepare(const Scene&, const FigureOutput& how, Studies&) {
    return [how](const Results& results) {
        if (!results.swept) throw std::logic_error("a figure of a sweep without its points");
        const SweptPoints points(*results.swept, how.lang);
        figure::Figure out = draw(points, how);
        out.name = recipe.name;
        out.title =
            filled(how.lang == Lang::en ? "{} over {}" : "{}：{}", recipe.title.in(how.lang), points.axis(0).name);
        out.caption = caption_words(points) + (out.caption.empty() ? "" : " ") + out.caption;
        out.accuracy = tolerance_words(points);
        return out;
    };
}

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
std::optional<std::string> needs_impacts(const Scene& scene) {
    if (auto why = needs_sweep(scene)) return why;
    if (scene.sweep->sampling.kind == sim::SampleKind::impacts) return std::nullopt;
    return "its samples are no impacts; set sweep.sample to \"impacts\"";
}

figure::Figure draw_bifurcation(const SweptPoints& points, const FigureOutput& how) {
    return bifurcation(points, how.value, as_numbered(points), [](auto...) {});
}
figure::Figure draw_map(const SweptPoints& points, const FigureOutput& how) { return key_map(points, how.value); }
figure::Figure draw_poincare(const SweptPoints& points, const FigureOutput&) {
    return points.of_impacts() ? sample_plane(points, "cam_phase", "v_n_before", false)
                               : sample_plane(points, "theta", "theta_dot", false);
}
figure::Figure draw_impact_map(const SweptPoints& points, const FigureOutput&) {
    return sample_plane(points, "cam_phase", "cam_phase", true);
}

Recipe recipe_of_sweep(const char* name, Words title, std::optional<std::string> (*refusal)(const Scene&),
                       decltype(Recipe::prepare) prepare, bool takes_value) {
    return {.name = name,
            .title = title,
            .refusal = refusal,
            .prepare = prepare,
            .of_sweep = true,
            .takes_value = takes_value};
}

}  // namespace

const Recipe kBifurcation = recipe_of_sweep("bifurcation", {"Bifurcation diagram", "分岔图"}, needs_one_key,
                                            prepare<kBifurcation, draw_bifurcation>, true);
const Recipe kBasins =
    recipe_of_sweep("basins", {"Basins of attraction", "吸引域"}, needs_two_starts, prepare<kBasins, draw_map>, true);
const Recipe kMap =
    recipe_of_sweep("map", {"Map of two keys", "双参数图"}, needs_two_keys, prepare<kMap, draw_map>, true);
const Recipe kPoincare = recipe_of_sweep("poincare", {"Poincaré section", "Poincaré 截面"}, needs_sweep,
                                         prepare<kPoincare, draw_poincare>, false);
const Recipe kImpactMap = recipe_of_sweep("impact-map", {"Map of impacts", "碰撞映射"}, needs_impacts,
                                          prepare<kImpactMap, draw_impact_map>, false);

std::string usual_diagram(const Scene& scene) {
    for (const Recipe& recipe : recipes())
        if (recipe.of_sweep && !recipe.refusal(scene)) return recipe.name;
    return kPoincare.name;
}

std::vector<std::string> diagram_values(std::string_view diagram, const Scene& scene) {
    std::vector<std::string> known;
    if (diagram != kBifurcation.name) known.assign(std::begin(kMapValues), std::end(kMapValues));
    for (const sim::SampleColumnInfo& column : sim::sample_columns())
        if (scene.sweep->sampling.kind == sim::SampleKind::impacts || !column.of_impacts)
            known.emplace_back(column.name);
    return known;
}

std::vector<std::string> diagram_names() {
    std::vector<std::string> names;
    for (const Recipe& recipe : recipes())
        if (recipe.of_sweep) names.emplace_back(recipe.name);
    return names;
}

}  // namespace beamcam::scenes
