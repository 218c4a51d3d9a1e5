// Markup as LaTeX and as plain text.
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

constexpr std::array kLatexText{SignPair{"–", "--"},
                                SignPair{"—", "---"},
                                SignPair{"\u00A0", "~"},
                                SignPair{"\u2009", "\\,"},
                                SignPair{"“", "``"},
                                SignPair{"”", "''"},
                                SignPair{"%", "\\%"},
                                SignPair{"&", "\\&"},
                                SignPair{"#", "\\#"},
                                SignPair{"_", "\\_"},
                                SignPair{"{", "\\{"},
                                SignPair{"}", "\\}"},
                                SignPair{"$", "\\$"},
                                SignPair{"~", "\\textasciitilde{}"},
                                SignPair{"^", "\\textasciicircum{}"},
                                SignPair{"\\", "\\textbackslash{}"},
                                SignPair{"…", "\\dots{}"},
                                SignPair{"µ", "\\textmu{}"}};

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

std::string latex_math(std::string_view text) {
    std::string out;
    each_character(text, [&](std::string_view c, std::string_view rest) {
        const std::string_view* known = find(kLatexMath, c);
        out += known ? *known : c;
        // A letter after a command would belong to its name.
        if (known && known->size() > 1 && known->front() == '\\' && known->back() != ' ' && !rest.empty()) out += ' ';
    });
    return out;
}

std::string latex_text(std::string_view text) {
    std::string out;
    each_character(text, [&](std::string_view c, std::string_view) {
        if (const std::string_view* known = find(kLatexText, c))
            out += *known;
        else if (const std::string_view* sign = find(kLatexMath, c))
            out += fmt::format("${}$", sign->substr(0, sign->find_last_not_of(' ') + 1));
        else
            out += c;
    });
    return out;
}

std::string latex_of(const std::vector<Run>& runs);

// LaTeX within a formula.
std::string latex_part(const std::vector<Run>& runs) {
    std::string out = latex_of(runs);
    std::erase(out, '$');
    return out;
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) || c == '.'; }

bool is_number(std::string_view text) {
    bool all = true;
    each_character(
        text, [&](std::string_view c, std::string_view) { all = all && (c == "−" || c == "+" || is_digit(c[0])); });
    return all;
}

std::string latex_run(const Run& run) {
    if (!run.under.empty()) return fmt::format("$\\frac{{{}}}{{{}}}$", latex_part(run.over), latex_part(run.under));
    if (!run.over.empty()) return fmt::format("$\\sqrt{{{}}}$", latex_part(run.over));
    std::string body = run.symbol ? latex_math(run.text) : latex_text(run.text);
    if (run.script == 0) {
        if (!run.symbol) return run.bold ? fmt::format("\\textbf{{{}}}", body) : body;
        if (run.dots) body = fmt::format("\\{}{{{}}}", run.dots == 1 ? "dot" : "ddot", body);
        return fmt::format("${}$", body);
    }
    if (!run.symbol)
        body = is_number(run.text) ? latex_math(run.text) : fmt::format("\\mathrm{{{}}}", latex_math(run.text));
    return fmt::format("${}{{{}}}$", run.script < 0 ? "_" : "^", body);
}

std::string latex_of(const std::vector<Run>& runs) {
    std::string out;
    for (const Run& run : runs) {
        const std::string piece = latex_run(run);
        // Joins formulas: "$x$$_{c}$" would start a displayed equation.
        if (out.ends_with("$") && !out.ends_with("\\$") && piece.starts_with("$")) {
            out.pop_back();
            out += piece.substr(1);
        } else if (piece.starts_with("$^") && !out.empty() && is_digit(out.back())) {  // a power of a number
            const auto number = std::find_if_not(out.rbegin(), out.rend(), is_digit).base();
            if (number != out.begin() && number[-1] == '$')  // after "$\\times$"
                out.erase(number - 1);
            else
                out.insert(number, '$');
            out += piece.substr(1);
        } else {
            out += piece;
        }
    }
    return out;
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

std::string to_latex(std::string_view markup) { return latex_of(parse_markup(markup)); }
std::string to_plain(std::string_view markup) { return plain_of(parse_markup(markup)); }

}  // namespace beamcam::render
