// The text of captions: the parameters of a problem, and numbers with the digits that are certain.
//
// Every figure describes its subject by these functions alone, so that a caption states nothing that the scene does
// not. All texts are markup (render/draw/markup.hpp).
#pragma once

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenes/scene/scene.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

// A text in both languages.
struct Translated {
    const char *en = "", *zh = "";
    std::string in(Lang lang) const { return lang == Lang::en ? en : zh; }
};

// The name of −v_n at a first touch, positive as in (S30).
inline constexpr Translated kApproachSpeed{"approach speed", "接近速度"};

// A text in the chosen language; with values as fmt::format makes it.
template <class... Values>
std::string phrase(Lang lang, const char* en, const char* zh, const Values&... values) {
    const char* text = lang == Lang::en ? en : zh;
    if constexpr (sizeof...(values) == 0)
        return text;
    else
        return fmt::format(fmt::runtime(text), values...);
}
std::string listed(const std::vector<std::string>& texts, Lang lang);  // "a, b"
std::string number(double value, int digits);                          // "0.25", "2.5×10^{−3}" with a true minus
std::string one_digit(double value);                                   // "10^{−8}", "2 × 10^{−9}"
std::string length_text(double metres);                                // "0.25 m", below a centimetre "236 µm"
std::string angular_speed_text(double speed, render::SpeedUnit unit);  // "5 rad s^{−1}"
std::string grouped(double value, int decimals);                       // "0.369 994": thin spaces between threes

// What a figure is about.
struct Subject {
    sim::Problem problem;
    render::Units units;  // of angles and speeds
    Lang lang;
    double end_time = 0;  // of the scene [s]
};
inline Subject subject_of(const Scene& scene, Lang lang) { return {scene.problem, scene.units, lang, scene.end_time}; }

// ---- facts ----------------------------------------------------------------------------------------

std::string model_name(sim::ModelKind model, Lang lang);  // "first-order", "一阶模型"
std::string shapes_name(sim::Basis basis, Lang lang);     // "hub–beam", "轮毂–梁"

// What a figure varies from curve to curve or from point to point, and the facts omit.
struct Varied {
    bool model = false, modes = false;
    std::vector<sim::Problem> others{};  // a fact that one of them does not share is left out
};

// Beam, hub, drive and start; with a cam also the cam and the contact. Speeds are in the subject's unit, angles
// in degrees.
std::string facts(const Subject& of, const Varied& varied = {});
// Beam, hub, drive and start alone.
std::string beam_facts(const Subject& of, const Varied& varied = {});

// Speeds of the cam in the paper's figure 6 [rad/s].
inline constexpr std::array kPaperSpeeds{0.0, 1.0, 5.0};

// Whether every parameter that the paper prints has its printed value; only then do captions mention the paper. The
// number of modes and the model are free.
bool is_of_the_paper(const sim::Problem& problem);

// "Relative tolerance 10⁻⁸; at the ends of steps the energy balance closes to 2 × 10⁻⁹ of its scale"; of several
// results the worst, with the words "of each motion".
using Runs = std::vector<std::pair<const sim::Problem*, const sim::Result*>>;
std::string accuracy(const Runs& runs, Lang lang);

// ---- digits ---------------------------------------------------------------------------------------

// The same problem with one shape function fewer (a rigid beam instead of the last one). The change that it makes
// bounds the effect of further shape functions. None for a rigid beam.
std::optional<sim::Problem> with_one_mode_fewer(const sim::Problem& problem);

// The decimal places that show two digits of an error, at most twelve.
int decimals_of(double error);

// A computed number and its uncertainty.
struct Estimate {
    double value = 0, error = 0;
};
// `fewer`: the number of the motion with one mode fewer; absent if that motion does not have it.
Estimate estimate(const sim::Problem& problem, double value, std::optional<double> fewer);
// With the digits that are certain, the last one uncertain by one; at least one digit: "0.369 99", "1.2×10^{3}".
std::string supported(const Estimate& estimate);
// A sentence that states what limits the digits of the numbers.
std::string digits_stated(const sim::Problem& problem, Lang lang);

}  // namespace beamcam::scenes
