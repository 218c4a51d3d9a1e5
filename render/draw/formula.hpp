// What formulas have and Pango's markup has not: parts above each other. They are written into a text's markup, outside
// all tags, and may nest; Canvas::text draws and Canvas::measure measures them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beamcam::render {

std::string fraction(std::string_view above, std::string_view below);
std::string root(std::string_view inside);
std::string scripts(std::string_view below, std::string_view above);  // of what stands before; one may be empty
std::string dotted(std::string_view letter, int dots);

// Between scripts that Pango would give different baselines, as between Chinese and mathematics.
inline std::string apart() { return scripts({}, {}); }

bool has_formula(std::string_view markup);

// A text in its parts.
struct FormulaPart {
    char kind = ' ';            // ' ': plain markup; else one of those above, by its first letter
    std::string first, second;  // markup
};
std::vector<FormulaPart> formula_parts(std::string_view markup);

}  // namespace beamcam::render
