// Words that users wrote, as markup of pictures: between dollars mathematics, as in figures (render/draw/markup.hpp);
// broken into lines where Unicode allows it: between words, and between the characters of scripts without spaces, never
// in a formula.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/draw/canvas.hpp"

namespace beamcam::render {

// A dollar that no other closes, and \\$, stand for themselves; so does a formula that cannot be read.
std::string words(const Canvas& canvas, std::string_view text);
// The same without markup, for files and other programs: "ω₁" of "$\\omega_1$" as "ω_1".
std::string plain_words(std::string_view text);
// Those that no font of pictures has, each once: "🙂 ☃". Loads fonts, where there are any but Latin ones; without
// fonts none.
std::string characters_without_font(std::string_view text);
// Why a formula cannot be read; empty: all can.
std::string problem_with_words(std::string_view text);

// Markup of the lines that a text fills, none wider than `style.max_width` [px] where it can be broken; at most
// `most` of them, the last with all that is left.
std::vector<std::string> wrapped(Canvas& canvas, std::string_view text, const TextStyle& style, std::size_t most);

}  // namespace beamcam::render
