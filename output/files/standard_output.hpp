// Data on standard output: all of it, or an error in words. Messages on standard error, as far as anybody reads them.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace beamcam::output {

// All of these write and flush, and throw IoError when the reader has gone or the disk is full.
void print_data(std::string_view text);  // for programs, byte by byte
void print_text(std::string_view text);  // for people: as text_safety.hpp's `visible`
void print_json(std::string_view text);  // for programs and people: as `escaped_json`

// Ends what was written to std::cout. Throws IoError as print_data.
void flush_data();

// For people, as print_text. A full disk or a reader that has gone does not end the work: nobody is left to read it.
void write_message(std::string_view text) noexcept;
template <typename... Values>
void print_message(fmt::format_string<Values...> text, Values&&... values) {
    write_message(fmt::format(text, std::forward<Values>(values)...));
}

}  // namespace beamcam::output
