// Data on standard output, complete or with an error. Messages on standard error, whose loss is no error.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace beamcam::output {

// These functions write and flush. They throw IoError if the disk is full; if the reader of the pipe has ended, they
// end the program with exit code 141.
void print_data(std::string_view text);  // for programs, byte by byte
void print_text(std::string_view text);  // for people: see `visible` in text_safety.hpp
void print_json(std::string_view text);  // for programs and people: see `escaped_json`

// Prints a message for people. A full disk or a closed pipe does not end the program.
void write_message(std::string_view text) noexcept;
template <typename... Values>
void print_message(fmt::format_string<Values...> text, Values&&... values) {
    write_message(fmt::format(text, std::forward<Values>(values)...));
}

}  // namespace beamcam::output
