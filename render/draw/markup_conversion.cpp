// Markup as plain text.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
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

// Calls visit(character, rest of the text) for each character.
template <class Visit>
void each_character(std::string_view text, const Visit& visit) {
    while (!text.empty()) {
        const std::string_view c = next_character(text, 0);
        text.remove_prefix(c.size());
        visit(c, text);
    }
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
        const bool digit = std::isdigit(static_cast<unsigned char>(c[0])),
                   first = rest.size() + c.size() == text.size();
        word = word && (digit || is_letter(c));
        number = number && (digit || c == "." || (first && c == "−"));
    });
    if (all) return out;
    return word || number ? fmt::format("{}{}", sign, text) : fmt::format("{}({})", sign, text);
}

std::string_view last_character(std::string_view text) {
    const char* const end = text.data() + text.size();
    const char* const at = g_utf8_prev_char(end);
    return {at, static_cast<std::size_t>(end - at)};
}

std::string plain_of(const std::vector<Run>& runs);

// A part of a fraction, or what a root covers: in parentheses unless it is one symbol with its scripts, or one number.
std::string plain_part(const std::vector<Run>& runs) {
    const std::string text = plain_of(runs);
    int symbols = 0;
    bool number = true, simple = true;
    for (const Run& run : runs) {
        simple = simple && run.over.empty();
        each_character(run.text, [&](std::string_view c, std::string_view) {
            const bool digit = std::isdigit(static_cast<unsigned char>(c[0])) || c == ".";
            number = number && digit;
            simple = simple && (digit || is_letter(c));
            symbols += run.script == 0;
        });
    }
    return simple && (number || symbols <= 1) ? text : fmt::format("({})", text);
}

// Whether a fraction beside this text needs a sign of multiplication.
bool is_factor(std::string_view character) {
    return is_letter(character) || character == ")" || character == "(" || character == "√" ||
           std::isdigit(static_cast<unsigned char>(character[0]));
}

std::string plain_of(const std::vector<Run>& runs) {
    std::string out;
    bool after_fraction = false, after_factor = false;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const Run& run = runs[i];
        if (run.script != 0) {  // belongs to what it follows
            std::string text = run.text;
            while (i + 1 < runs.size() && runs[i + 1].script == run.script) text += runs[++i].text;
            out += run.script > 0 ? script_text(text, kSuperscripts, "^") : script_text(text, kSubscripts, "_");
            continue;
        }
        const bool fraction = !run.under.empty();
        std::string text = run.text;
        if (fraction)
            text = plain_part(run.over) + "/" + plain_part(run.under);
        else if (!run.over.empty())
            text = "√" + plain_part(run.over);
        if (text.empty()) continue;
        if ((after_fraction && (fraction || is_factor(next_character(text, 0)))) || (fraction && after_factor))
            out += "·";
        out += text;
        if (run.dots > 0) out += run.dots == 1 ? "\u0307" : "\u0308";
        const std::string_view last = last_character(text);
        after_fraction = fraction;
        after_factor = is_factor(last) && last != "(";
    }
    return out;
}

}  // namespace

std::string to_plain(std::string_view markup) { return plain_of(parse_markup(markup)); }

}  // namespace beamcam::render
