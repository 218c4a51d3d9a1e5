// Text of foreign files on its way to a terminal: nothing in it may move the cursor, change colours, or reorder what
// stands beside it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace beamcam::output {

// The UTF-8 character at the front of a text that is not empty; 0 bytes when there is none (overlong forms, surrogates
// and what is beyond U+10FFFF included).
struct Character {
    std::size_t bytes = 0;
    char32_t code = 0;
};
Character first_character(std::string_view text);

// Every control character but tab and line feed, every mark of direction, every separator of lines, and every byte that
// is not UTF-8 becomes U+FFFD.
std::string visible(std::string_view text);
// The same, and tabs and line breaks become spaces.
std::string one_line(std::string_view text);
// The same of a JSON text, where such characters stand in strings only: they become \uXXXX.
std::string escaped_json(std::string_view json);

}  // namespace beamcam::output
