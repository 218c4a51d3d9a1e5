// The figures by name: what each needs of the mechanics, and how it comes out of the results.
//
// A recipe is asked first for its needs, which join those of other figures in one set of studies, and
// then makes a Figure from the results. It neither integrates nor draws.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "render/base/error.hpp"
#include "render/plot/figure.hpp"
#include "scenes/figures/caption.hpp"
#include "scenes/figures/studies.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

using FigureMaker = std::function<render::figure::Figure(const Results&)>;

struct Recipe {
    const char* name;
    Words title;
    // Why the scene has no such figure, with the remedy; nothing when it has. `refusal_of` asks for more.
    std::optional<std::string> (*refusal)(const Scene& scene);
    // Adds the needs; the maker remembers where they are. `how`: the language, and what keys of the figure's own say.
    FigureMaker (*prepare)(const Scene& scene, const FigureOutput& how, Studies& studies);
    bool takes_stretch = false;  // the keys "from" and "to"
    bool takes_channel = false;  // one of "channels", and the keys of its windows
    bool of_sweep = false;       // it shows the points of the scene's sweep
    bool takes_value = false;    // the key "value"
};

std::span<const Recipe> recipes();
std::vector<std::string> recipe_names();
const Recipe* recipe_named(std::string_view name);  // nullptr: none

// The recipe's own refusal, or that of a motion without which it has no figure: the problem is impossible.
std::optional<std::string> refusal_of(const Recipe& recipe, const Scene& scene);

// The recipes of each file of this folder.
extern const Recipe kSchematic, kFreeFall, kTipVibration, kDeflection, kDistance, kAngle, kSpeeds, kCollision, kEnergy,
    kContactPlaces, kPhase, kApexModes, kModels, kSeries, kKymograph, kSpectrogram, kStrobe, kImpactMaps,
    kImpactHistograms, kBifurcation, kBasins, kMap, kPoincare, kImpactMap;

// ---- what they share ------------------------------------------------------------------------------

inline std::optional<std::string> no_refusal(const Scene&) { return std::nullopt; }
std::optional<std::string> needs_cam(const Scene& scene);
std::optional<std::string> needs_free_hub(const Scene& scene);
std::optional<std::string> needs_start_off_the_cam(const Scene& scene);
std::optional<std::string> needs_fall(const Scene& scene);  // both of these

// Of an impact or a collision. A beam that rests on the cam at the start touches it without striking it.
template <class Touch>
bool strikes(const sim::Problem& problem, const Touch& touch) {
    return touch.t_start > 0 || problem.initial.shape != sim::InitialShape::resting;
}

// Counted from 1; null: there are fewer.
const sim::Collision* collision_of(const sim::Problem& problem, const sim::Result& result, int number);
// The angle θ at the apex of the first rebound; of a motion cut short before `end` only where a second collision ends
// the search.
std::optional<double> rebound_apex(const sim::Result& result, double end);
// Rows over the scene: an impact lasts a few tenths of a millisecond.
int contact_rows(double end);

sim::Problem without_cam(sim::Problem problem);
sim::Problem rigid(sim::Problem problem);

std::vector<double> scaled(std::vector<double> values, double factor);

}  // namespace beamcam::scenes
