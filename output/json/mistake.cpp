#include "output/json/mistake.hpp"

#include <fmt/format.h>
#include <glib.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "output/files/text_safety.hpp"
#include "output/json/source.hpp"

namespace beamcam {
namespace {

char closing_bracket(char opening) { return opening == '{' ? '}' : ']'; }

std::string mistake_at_end(std::string_view text, std::optional<std::size_t> opening) {
    if (!opening) return "the file ends too early; a scene is one object { … }";
    const char bracket = text[*opening];
    return fmt::format("this {} is never closed: the file ends before its '{}'", bracket == '{' ? "object" : "array",
                       closing_bracket(bracket));
}

std::string mistake_in_bracket(std::string_view text, char c, Expected expected, std::optional<std::size_t> opening) {
    if (!opening) return fmt::format("an unmatched '{}'; remove it", c);
    const char bracket = text[*opening];
    if (c != closing_bracket(bracket))
        return fmt::format("'{}' closes what '{}' in line {} opened; write '{}'", c, bracket,
                           locate(text, *opening).line, closing_bracket(bracket));
    return expected == Expected::separator ? fmt::format("'{}' does not belong here; remove it", c)
                                           : "a value is missing before this; write it, or remove the key";
}

std::string mistake_in_string(std::string_view token) {
    if (token.size() < 2 || token.back() != '"' || token.find('\r') != std::string_view::npos)
        return "this text has no closing quote in its line; close it with \" (a line break inside a text is \\n)";
    if (std::ranges::any_of(token, [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
        return "this text contains a control character; write it as \\t or \\u0000";
    return "this text contains an escape that JSON does not have; write \\\\ for a backslash, and the character itself "
           "instead of half a surrogate pair";
}

// One past the comment that begins at `at`; npos: there is none.
std::size_t after_comment(std::string_view text, std::size_t at) {
    if (at >= text.size() || text[at] != '/') return std::string_view::npos;
    const std::string_view begin = text.substr(at, 2);
    if (begin == "//") return std::min(text.find_first_of("\n\r", at), text.size());
    const std::size_t end = begin == "/*" ? text.find("*/", at + 2) : std::string_view::npos;
    return end == std::string_view::npos ? end : end + 2;
}

}  // namespace

std::string_view first_word(std::string_view text) {
    const auto is_part = [](char c) { return g_ascii_isalnum(c) || c == '.' || c == '-' || c == '+' || c == '_'; };
    std::size_t end = 0;
    while (end < text.size() && is_part(text[end])) ++end;
    return text.substr(0, end);
}

std::size_t after_blanks(std::string_view text, std::size_t at) {
    const auto is_blank = [&] { return text[at] == ' ' || text[at] == '\n' || text[at] == '\t' || text[at] == '\r'; };
    while (true) {
        while (at < text.size() && is_blank()) ++at;
        const std::size_t after = after_comment(text, at);
        if (after == std::string_view::npos) return at;
        at = after;
    }
}

std::size_t after_string(std::string_view text, std::size_t at) {
    for (++at; at < text.size() && text[at] != '"' && text[at] != '\n'; ++at)
        if (text[at] == '\\') ++at;
    return std::min(at + 1, text.size());
}

std::string mistake_in_word(std::string_view word) {
    if (word == "NaN" || word == "nan" || word.ends_with("Infinity") || word.ends_with("inf"))
        return fmt::format("{} is not a number that a scene can have; write a finite number", shortened(word));
    if (word.size() > 1 && word[0] == '0' && g_ascii_isdigit(word[1]))
        return fmt::format("number {} begins with 0; JSON writes it without", shortened(word));
    if (word[0] == '+' || word[0] == '.' || word[0] == '-' || g_ascii_isdigit(word[0]))
        return fmt::format(
            "{} is not a number in JSON; write for example 0.5, -3 or 1e-8, and \"12 mm\" with a unit in quotes",
            in_quotes(word));
    return fmt::format("{} has no quotes; put names and texts in double quotes (only true, false and null have none)",
                       in_quotes(word));
}

std::string mistake(std::string_view text, std::size_t at, Expected expected, std::optional<std::size_t> opening) {
    if (at >= text.size()) return mistake_at_end(text, opening);
    const char c = text[at];
    const std::string_view rest = text.substr(at), word = first_word(rest);
    if (c == '"' && (expected == Expected::key || expected == Expected::value))
        return mistake_in_string(text.substr(at, after_string(text, at) - at));
    if (c == '/' || c == '#') return "a comment that is not closed, or of an unknown kind; write // … or /* … */";
    if (c == '\'') return "a single quote; put texts and keys in double quotes: \"…\"";
    if (expected == Expected::colon) return "a colon is missing between a key and its value";
    if (c == ',') return "a comma where a key or a value is expected; remove it, or write what is missing";
    const bool is_value = c == '"' || c == '{' || c == '[' || nlohmann::json::accept(word);
    if (is_value && expected == Expected::separator) return "a comma is missing before this";
    if (is_value) return "a key is expected here, in double quotes: \"key\": value";
    if (!word.empty()) return mistake_in_word(word);
    if (c == '}' || c == ']') return mistake_in_bracket(text, c, expected, opening);
    const std::string_view character = rest.substr(0, output::first_character(rest).bytes);
    if (character == "“" || character == "”" || character == "‘" || character == "’")
        return "a typographic quote; put texts and keys in straight double quotes: \"…\"";
    return fmt::format("{} does not belong here; compare with the scene of `beamcam init -`", in_quotes(character));
}

}  // namespace beamcam
