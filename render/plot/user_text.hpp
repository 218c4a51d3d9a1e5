// User text as markup of pictures: mathematics between dollars, as in figures (render/draw/markup.hpp). Lines break
// where Unicode allows it: between words, and between the characters of scripts without spaces, never in a formula.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/draw/canvas.hpp"

namespace beamcam::render {

// An unclosed dollar and \\$ are dollars; a formula that cannot be parsed is shown as it is written.
std::string text_markup(const Canvas& canvas, std::string_view text);
// The same without markup, for files and other programs: "ω₁" of "$\\omega_1$" as "ω_1".
std::string plain_text(std::string_view text);
// The characters that no font has, each once: "🙂 ☃". Loads fonts if there are any but Latin characters; empty if
// no fonts are found.
std::string characters_without_font(std::string_view text);
// Why a formula cannot be parsed; empty: all can.
std::string markup_problem(std::string_view text);

// Markup of the lines of a text, none wider than `style.max_width` [px] if it can be broken; at most `most` lines, the
// last with the rest of the text.
std::vector<std::string> wrapped_lines(Canvas& canvas, std::string_view text, const TextStyle& style, std::size_t most);

}  // namespace beamcam::render
