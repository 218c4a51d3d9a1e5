// User text as markup (render/draw/markup.hpp). Lines break where Unicode allows it: between words, and between the
// characters of scripts without spaces, never in a formula.
#pragma once

#include <string>
#include <string_view>
#include <vector>

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

// Markup of the lines of a text, none wider than `style.max_width` [px] if it can be broken; at most `most` lines, the
// last with the rest of the text.
std::vector<std::string> wrapped_lines(const Canvas& canvas, std::string_view text, const TextStyle& style,
                                       std::size_t most);

}  // namespace beamcam::render
