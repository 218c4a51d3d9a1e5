// The caption of a figure: its title, the parameters that differ from the defaults, and the accuracy of its motions.
// All texts are markup (render/draw/markup.hpp).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "render/plot/figure.hpp"
#include "render/plot/lang.hpp"
#include "scenes/scene/scene.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

using render::phrase;

std::string number(double value, int digits);     // "0.25", "2.5×10^{−3}" with a true minus
std::string one_digit(double value);              // "10^{−8}", "2 × 10^{−9}"
std::string length_text(double metres);           // "0.25 m", below a centimetre "236 µm"
std::string grouped(double value, int decimals);  // "0.369 994": thin spaces between threes
int decimals_of(double error);                    // that show two digits of an error, at most twelve

std::string words_of(std::string key);  // "cam speed" of cam.speed

// The subject of a figure.
struct Subject {
    sim::Problem problem;
    render::Units units;  // of angles and speeds
    Lang lang;
    double end_time = 0;  // of the scene [s]
};
inline Subject subject_of(const Scene& scene, Lang lang) { return {scene.problem, scene.units, lang, scene.end_time}; }

// The motions that a figure shows.
using Runs = std::vector<std::pair<const sim::Problem*, const sim::Result*>>;

// "beam modes = 6, beam length = 120 mm": the parameters of the scene that differ from the defaults and are the same in
// all problems, in the units of the figure's axes; empty: there are none.
std::string parameters(const std::vector<const sim::Problem*>& problems, const render::Units& units);
// "Relative tolerance 10⁻⁸; at the ends of steps the energy balance closes to 2 × 10⁻⁹ of its scale.", of several
// motions the worst.
std::string accuracy(const Runs& runs);

// Adds caption and accuracy for these motions; where a curve is paler, θ is not reproducible, which is stated.
void add_caption(render::figure::Figure& figure, const Runs& runs, const render::Units& units);
// Adds the caption alone: of a figure for which nothing is integrated, or that states its accuracy itself.
void add_caption(render::figure::Figure& figure, const std::vector<sim::Problem>& problems, const render::Units& units);
// "Energies: (a) kinetic, potential; (b) bending": the title with the captions of the panels that have letters.
std::string title_with_panels(const std::string& title, const std::vector<render::figure::Panel>& panels);
// Title, caption and accuracy of a figure.
std::string whole_caption(const render::figure::Figure& figure);

// Whether every parameter that the paper prints has its printed value; only then do figures show the paper's formulas.
// The number of modes and the model are free.
bool is_of_the_paper(const sim::Problem& problem);

}  // namespace beamcam::scenes
