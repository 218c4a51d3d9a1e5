// Text of untrusted files for a terminal: it must not move the cursor, change colours, or reorder neighbouring text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace beamcam::output {

// The UTF-8 character at the beginning of a text that is not empty; 0 bytes if it is invalid (also overlong forms,
// surrogates and values above U+10FFFF).
struct Character {
    std::size_t bytes = 0;
    char32_t code = 0;
};
Character first_character(std::string_view text);

// Replaces control characters other than tab and line feed, directional marks, line separators, and bytes that are not
// UTF-8 by U+FFFD.
std::string visible(std::string_view text);
// Like `visible`; tabs and line breaks become spaces, too.
std::string one_line(std::string_view text);
// The text of JSON, where such characters occur only in strings: they become \uXXXX.
std::string escaped_json(std::string_view json);

}  // namespace beamcam::output
