// User text as markup (render/draw/markup.hpp).
#pragma once

#include <string>
#include <string_view>

#include "render/draw/canvas.hpp"
#include "render/draw/markup.hpp"

namespace beamcam::render {

// Mathematics between dollars, everything else as it is written: an unclosed dollar and \\$ are dollars, and a formula
// that cannot be parsed is shown unchanged.
std::string text_markup(std::string_view text);
// The same without markup, for files and other programs: "ω₁" of "$\\omega_1$" as "ω_1".
inline std::string plain_text(std::string_view text) { return to_plain(text_markup(text)); }
// The characters that no font has, each once: "🙂 ☃". Loads fonts if there are any but Latin characters; empty if
// no fonts are found.
std::string characters_without_font(std::string_view text);
// Why a formula cannot be parsed; empty: all can.
std::string markup_problem(std::string_view text);

// A text (plain, with formulas) on one line.
struct FittedText {
    std::string markup;
    double size = 0;   // of the letters [px]
    bool cut = false;  // it ends with an ellipsis
};
// In the size of the style where there is room for it, else in the smaller one, else its beginning in that one.
FittedText fitted_text(const Canvas& canvas, std::string_view text, TextStyle style, double smaller, double room);

}  // namespace beamcam::render
