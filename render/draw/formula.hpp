// Formulas in a text that is Pango's markup otherwise: each is the markup of figures (markup.hpp) between two signs
// that no text has. Canvas::text draws and Canvas::measure measures them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beamcam::render {

std::string formula(std::string_view markup);  // outside all tags
bool has_formula(std::string_view text);

// Between scripts that Pango would give different baselines, as between Chinese and mathematics.
inline std::string apart() { return formula({}); }

struct TextPart {
    bool formula = false;
    std::string markup = {};  // Pango's, or that of figures
};
std::vector<TextPart> text_parts(std::string_view text);

}  // namespace beamcam::render
