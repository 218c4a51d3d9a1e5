// Markup as plain text and as HTML.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "render/draw/markup.hpp"
#include "render/draw/markup_signs.hpp"

namespace beamcam::render {
namespace {

template <std::size_t N>
const std::string_view* find(const std::array<SignPair, N>& table, std::string_view c) {
    const auto it = std::find_if(table.begin(), table.end(), [&](const SignPair& p) { return p.first == c; });
    return it == table.end() ? nullptr : &it->second;
}

constexpr std::array kSuperscripts{SignPair{"0", "⁰"}, SignPair{"1", "¹"}, SignPair{"2", "²"}, SignPair{"3", "³"},
                                   SignPair{"4", "⁴"}, SignPair{"5", "⁵"}, SignPair{"6", "⁶"}, SignPair{"7", "⁷"},
                                   SignPair{"8", "⁸"}, SignPair{"9", "⁹"}, SignPair{"−", "⁻"}, SignPair{"+", "⁺"}};
constexpr std::array kSubscripts{SignPair{"0", "₀"}, SignPair{"1", "₁"}, SignPair{"2", "₂"}, SignPair{"3", "₃"},
                                 SignPair{"4", "₄"}, SignPair{"5", "₅"}, SignPair{"6", "₆"}, SignPair{"7", "₇"},
                                 SignPair{"8", "₈"}, SignPair{"9", "₉"}};

// In small letters if Unicode has all of them; else after `sign`, in parentheses unless it is a word or a number.
template <std::size_t N>
std::string script_text(std::string_view text, const std::array<SignPair, N>& small, const char* sign) {
    std::string out;
    bool all = true, word = true, number = true;
    each_character(text, [&](std::string_view c, std::string_view rest) {
        const std::string_view* known = find(small, c);
        all = all && known;
        if (known) out += *known;
        const bool digit = is_digit(c), first = rest.size() + c.size() == text.size();
        word = word && (digit || is_letter(c));
        number = number && (digit || c == "." || (first && c == "−"));
    });
    if (all) return out;
    return word || number ? fmt::format("{}{}", sign, text) : fmt::format("{}({})", sign, text);
}

}  // namespace

std::string to_plain(std::string_view markup) {
    std::string out;
    const std::vector<Run> runs = parse_markup(markup);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const Run& run = runs[i];
        std::string text = run.text;
        if (run.script != 0) {
            while (i + 1 < runs.size() && runs[i + 1].script == run.script) text += runs[++i].text;
            out += run.script > 0 ? script_text(text, kSuperscripts, "^") : script_text(text, kSubscripts, "_");
            continue;
        }
        out += text;
        if (run.dots > 0) out += run.dots == 1 ? "\u0307" : "\u0308";
    }
    return out;
}

std::string to_html(std::string_view markup) {
    std::string out;
    for (const Run& run : parse_markup(markup)) {
        const char* script = run.script > 0 ? "sup" : "sub";
        const std::string text = run.symbol ? "<i>" + xml(run.text) + "</i>" : xml(run.text);
        out += run.script == 0 ? text : fmt::format("<{0}>{1}</{0}>", script, text);
    }
    return out;
}

}  // namespace beamcam::render
