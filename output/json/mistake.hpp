// What is wrong at a place where a text ceases to be JSON, and the remedy.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace beamcam {

enum class Expected { value, key, colon, separator };

// `at` is where the mistake begins, which may be the end of the text. `opening` is the place of the innermost open
// bracket, if there is one.
std::string mistake(std::string_view text, std::size_t at, Expected expected, std::optional<std::size_t> opening);
// The mistake in a word where a value is expected.
std::string mistake_in_word(std::string_view word);

// The letters, digits and signs at the beginning of the text: a number, true, a name without quotes.
std::string_view first_word(std::string_view text);
// The next byte that is neither white space nor in a closed comment.
std::size_t after_blanks(std::string_view text, std::size_t at);
// One past the quote that closes the text which begins at `at`, or past the end of the line.
std::size_t after_string(std::string_view text, std::size_t at);
std::size_t line_of(std::string_view text, std::size_t offset);  // from 1; reads the text up to there

}  // namespace beamcam
