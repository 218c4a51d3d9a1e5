#include "output/files/text_safety.hpp"

#include <fmt/format.h>
#include <glib.h>

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
    const auto first = static_cast<unsigned char>(text.front());
    if (first < 0x80) return {1, first};  // most characters; and U+0000, which ends a text for GLib
    const gunichar code = g_utf8_get_char_validated(text.data(), static_cast<gssize>(text.size()));
    constexpr gunichar kInvalid = 0x80000000;  // and what is above it
    if (code >= kInvalid) return {};
    return {static_cast<std::size_t>(g_utf8_skip[first]), code};
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
