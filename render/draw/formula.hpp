// Formulas within Pango markup: each is figure markup (markup.hpp) between two control characters. Canvas::text draws
// them, Canvas::measure measures them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beamcam::render {

std::string formula(std::string_view markup);  // must be outside all Pango tags
bool has_formula(std::string_view text);

// An empty formula: separates scripts for which Pango would use different baselines, such as Chinese and mathematics.
inline std::string script_break() { return formula({}); }

struct TextPart {
    bool formula = false;
    std::string markup = {};  // Pango markup or figure markup
};
std::vector<TextPart> text_parts(std::string_view text);

}  // namespace beamcam::render
