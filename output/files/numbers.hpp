// Numbers as text, independent of the locale, with 17 significant digits: reading them gives the same bits; and as
// bytes.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace beamcam::output {

// Appends the value, or nothing if it is undefined (NaN).
inline void append_number(std::string& text, double value) {
    if (std::isnan(value)) return;
    char buffer[32];  // sign, 17 digits, point, e, sign, 3 digits: 25
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 17);
    text.append(buffer, end.ptr);
}

// Appends the lowest `count` bytes of the value, the lowest first.
inline void append_bytes(std::string& out, std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) out.push_back(static_cast<char>(value >> (8 * i) & 0xff));
}

// The whole text as a number; nothing if it is not a number or does not fit into the type.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

}  // namespace beamcam::output
