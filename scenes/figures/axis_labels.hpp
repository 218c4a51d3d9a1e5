// Symbols and units on the axes of figures, as markup (render/draw/markup.hpp), and the prefixes that suit values.
#pragma once

#include <string>
#include <vector>

#include "render/film/film.hpp"
#include "scenes/scene/outputs.hpp"

namespace beamcam::scenes {

// The symbol of a key of the scene or of a column of samples: "$ω$" for cam.speed; the name itself where it has no
// symbol.
std::string symbol_of(const std::string& name);
// "cam speed $ω$": its words and its symbol, if it has one.
std::string key_text(const std::string& key);
// "$ω$ / (rad s^{−1})"; without unit the symbol alone.
std::string axis_label(const std::string& symbol, const std::string& unit);
// "48 rad s^{−1}", "90° s^{−1}"; without unit the number alone.
std::string with_unit(const std::string& number, const std::string& unit);
// "$ω$ = 48 rad s^{−1}"
std::string value_label(const std::string& symbol, double value, const std::string& unit);

// How the values of a quantity are written along an axis: multiplied by `factor`, in `unit`, which may be empty.
struct Measure {
    double factor = 1;
    std::string unit;
};
// Angles and speeds are in the scene's units, other quantities in SI units.
Measure measure_in(const render::Units& units, const std::string& si_unit);
// In a unit that the user names.
Measure measure_in(const AxisUnit& unit);
// The prefix that suits the largest value, in SI units; of m, N, J and s alone.
Measure measure_of(const std::string& unit, double largest);
// The unit of the scene, for angles and speeds, or else the prefix that suits the largest value.
Measure measure_of(const std::string& unit, double largest, const render::Units& units);
double largest_magnitude(const std::vector<double>& values);  // 0: there is no finite one

}  // namespace beamcam::scenes
