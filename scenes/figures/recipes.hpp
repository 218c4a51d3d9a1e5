// The figures by name: what each needs of the mechanics, and how it comes out of the results.
//
// A recipe is asked first for its needs, which join those of other figures in one set of studies, and
// then makes a Figure from the results. It neither integrates nor draws.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "render/error.hpp"
#include "render/figure/figure.hpp"
#include "scenes/figures/studies.hpp"
#include "scenes/scene.hpp"

namespace beamcam::scenes {

// A text in both languages.
struct Words {
    const char* en;
    const char* zh;
    std::string in(Lang lang) const { return lang == Lang::en ? en : zh; }
};

using FigureMaker = std::function<render::figure::Figure(const Results&)>;

struct Recipe {
    const char* name;
    Words title;
    // Why the scene has no such figure, in words with the remedy; nothing when it has.
    std::optional<std::string> (*refusal)(const Scene& scene);
    // Adds the needs; the maker remembers where they are.
    FigureMaker (*prepare)(const Scene& scene, Lang lang, Studies& studies);
};

std::span<const Recipe> recipes();
const Recipe* recipe_named(std::string_view name);  // nullptr: none

// The recipes of each file of this folder.
extern const Recipe kSchematic, kFreeFall, kTipVibration, kDeflection, kDistance, kAngle, kSpeeds, kCollision, kEnergy,
    kContactPlaces, kPhase, kApexModes, kModels;

// ---- what they share ------------------------------------------------------------------------------

inline std::optional<std::string> no_refusal(const Scene&) { return std::nullopt; }
std::optional<std::string> needs_cam(const Scene& scene);
std::optional<std::string> needs_free_hub(const Scene& scene);

sim::Problem without_cam(sim::Problem problem);
sim::Problem rigid(sim::Problem problem);

// Markup of the scene's numbers, as captions state them: the beam's; and the cam's and contact's, with what is an
// assumption because the paper does not print it.
std::string assumptions(const sim::Problem& problem, Lang lang);
std::string stated(const sim::Problem& problem, Lang lang);
// "rtol 10⁻⁸; the energy ledger closes to 2 × 10⁻⁹": markup, of the worst of the results.
std::string accuracy(const std::vector<std::pair<const sim::Problem*, const sim::Result*>>& runs, Lang lang);

// fmt::format with a text chosen by language while running.
template <class... Values>
std::string filled(const char* text, const Values&... values) {
    return fmt::format(fmt::runtime(text), values...);
}
std::string number(double value, int digits);     // "0.25", "2.5×10^{−3}" with a true minus
std::string grouped(double value, int decimals);  // "0.369 994": thin spaces between threes
std::vector<double> scaled(std::vector<double> values, double factor);

}  // namespace beamcam::scenes
