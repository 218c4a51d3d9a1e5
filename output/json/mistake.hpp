// A message names the mistake where a text ceases to be JSON, and its remedy.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace beamcam {

enum class Expected { value, key, colon, separator };

// Returns the message. `at` is where the mistake begins, which may be the end of the text. `opening` is the place of the
// innermost open bracket, if there is one.
std::string mistake(std::string_view text, std::size_t at, Expected expected, std::optional<std::size_t> opening);
// Returns the message for a word in the place of a value.
std::string mistake_in_word(std::string_view word);

// Returns the letters, digits and signs at the beginning of the text: a number, true, a name without quotes.
std::string_view first_word(std::string_view text);
// Returns the place of the next byte that is neither white space nor in a closed comment.
std::size_t after_blanks(std::string_view text, std::size_t at);
// Returns the place after the quote that closes the text which begins at `at`, or after the end of the line.
std::size_t after_string(std::string_view text, std::size_t at);

}  // namespace beamcam
