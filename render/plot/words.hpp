// Text broken into lines, where Unicode allows it: between words, and between the characters of scripts without spaces.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/draw/canvas.hpp"

namespace beamcam::render {

// Markup of the lines that plain text fills, none wider than `style.max_width` [px] where it can be broken; at most
// `most` of them, the last with all that is left.
std::vector<std::string> wrapped(Canvas& canvas, std::string_view plain, const TextStyle& style, std::size_t most);

}  // namespace beamcam::render
