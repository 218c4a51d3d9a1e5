// The characters of JSON texts: encoding, words, numbers.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "output/json/source.hpp"

namespace beamcam {

// Why a text of at most `largest` bytes is not JSON at all.
std::optional<Message> encoding_problem(std::string_view text, std::size_t source, std::size_t largest);
// The letters, digits and signs at the beginning of the text.
std::string_view first_word(std::string_view text);
// True for -12.5e-3; false for +1, .5, 01, 1. and 0x10.
bool is_number_of_json(std::string_view word);

}  // namespace beamcam
