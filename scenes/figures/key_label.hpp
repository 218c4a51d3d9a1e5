// Symbols and units on the axes of figures, as markup (render/draw/markup.hpp).
#pragma once

#include <string>

#include "sim/problem/problem.hpp"

namespace beamcam::scenes {

// Of a key of the scene or a column of samples: "$ω$" for cam.speed; the name itself where it has no symbol.
std::string symbol_of(const std::string& name);
// "$ω$ / (rad s^{−1})"; without unit the symbol alone.
std::string axis_label(const std::string& symbol, const std::string& unit);
// "$ω$ = 48 rad s^{−1}"
std::string value_label(const std::string& symbol, double value, const std::string& unit);
// Of a key of this problem that is a number.
std::string key_label(const std::string& key, const sim::Problem& problem);

}  // namespace beamcam::scenes
