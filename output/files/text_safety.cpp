#include "output/files/text_safety.hpp"

#include <fmt/format.h>

namespace beamcam::output {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

bool is_unsafe(char32_t c) {
    if (c < 0x20) return c != '\n' && c != '\t';
    const auto within = [c](char32_t first, char32_t last) { return c >= first && c <= last; };
    return within(0x7F, 0x9F)            // delete, C1 controls
           || c == 0x061C                // Arabic letter mark
           || within(0x200B, 0x200F)     // zero width; left-to-right and right-to-left marks
           || within(0x2028, 0x202E)     // line and paragraph separators; embeddings and overrides
           || within(0x2060, 0x206F)     // invisible operators, isolates, deprecated format characters
           || c == 0xFEFF                // byte order mark
           || within(0xFFF9, 0xFFFB)     // interlinear annotations
           || within(0xE0000, 0xE007F);  // tags
}

// Copies the text; `replace` returns the replacement of an unsafe character (code) or an invalid byte (bytes = 0).
template <typename Replace>
std::string copy(std::string_view text, Replace replace) {
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        const Character c = first_character(text);
        const std::size_t bytes = c.bytes > 0 ? c.bytes : 1;
        if (c.bytes == 0 || is_unsafe(c.code))
            out += replace(c);
        else
            out += text.substr(0, bytes);
        text.remove_prefix(bytes);
    }
    return out;
}

}  // namespace

Character first_character(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    if (first < 0x80) return {1, first};
    const std::size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    if (first < 0xC2 || first > 0xF4 || bytes > text.size()) return {};
    char32_t code = first & (0x7Fu >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return {};
        code = code << 6 | (byte(i) & 0x3Fu);
    }
    constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool exists = code >= kLeast[bytes] && code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF);
    return exists ? Character{bytes, code} : Character{};
}

std::string visible(std::string_view text) {
    return copy(text, [](const Character&) { return kReplacement; });
}

std::string one_line(std::string_view text) {
    std::string out = visible(text);
    for (char& c : out)
        if (c == '\n' || c == '\t') c = ' ';
    return out;
}

std::string escaped_json(std::string_view json) {
    return copy(json, [](const Character& c) {
        if (c.bytes == 0) return std::string(kReplacement);
        const auto code = static_cast<unsigned>(c.code);
        if (code < 0x10000) return fmt::format("\\u{:04x}", code);
        return fmt::format("\\u{:04x}\\u{:04x}", 0xD7C0 + (code >> 10), 0xDC00 + (code & 0x3FF));
    });
}

}  // namespace beamcam::output
